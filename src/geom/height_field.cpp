// Height fields (height_field.h).
#include <avbd/error.h>
#include <avbd/height_field.h>

namespace avbd {

struct HeightFieldData::Parts {};
HeightFieldData::~HeightFieldData() = default;
std::shared_ptr<const HeightFieldData> makeHeightField(const HeightFieldDef&) {
  throw Error("HeightFieldDef", "heights", "0", "not built yet");
}

}  // namespace avbd
