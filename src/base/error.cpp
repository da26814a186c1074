// Messages of what the library throws.
#include <avbd/error.h>

#include <utility>

namespace avbd {
namespace {

std::string refusal(const std::string& definition, const std::string& field, const std::string& value,
                    const std::string& range) {
  std::string text = definition;
  if (!field.empty()) text += "." + field;
  if (!value.empty()) text += " = " + value;
  return range.empty() ? text : text + ": " + range;
}

std::string nonFinite(const std::string& stage, uint32_t index, uint32_t generation) {
  return "step stopped at " + stage + ": the state of body " + std::to_string(index) + " (generation " +
         std::to_string(generation) + ") is not finite";
}

}  // namespace

Error::Error(std::string definition, std::string field, std::string value, std::string range)
    : std::runtime_error(refusal(definition, field, value, range)),
      definition_(std::move(definition)),
      field_(std::move(field)),
      value_(std::move(value)),
      range_(std::move(range)) {}

NonFiniteError::NonFiniteError(std::string stage, uint32_t bodyIndex, uint32_t bodyGeneration)
    : std::runtime_error(nonFinite(stage, bodyIndex, bodyGeneration)),
      stage_(std::move(stage)),
      bodyIndex_(bodyIndex),
      bodyGeneration_(bodyGeneration) {}

}  // namespace avbd
