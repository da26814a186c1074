// `avbd scenes`, and scenes by name.
#include <algorithm>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/failure.h"
#include "app/near_names.h"
#include "app/number_text.h"
#include "scenes/large.h"

namespace avbd::cli {

int scenesCommand(std::ostream& out) {
  size_t width = 0;
  for (const auto* list : {&scenes::all(), &scenes::large()})
    for (const scenes::Scene& s : *list) width = std::max(width, s.name.size());
  for (const auto* list : {&scenes::all(), &scenes::large()})
    for (const scenes::Scene& s : *list)
      out << padded(s.name, width + 2) << padded(s.alias, 4) << s.description << "\n";
  return kExitDone;
}

const scenes::Scene& sceneNamed(const std::string& name) {
  if (const scenes::Scene* scene = scenes::find(name)) return *scene;
  std::vector<std::string> names;
  for (const auto* list : {&scenes::all(), &scenes::large()})
    for (const scenes::Scene& s : *list) {
      names.push_back(s.name);
      if (!s.alias.empty()) names.push_back(s.alias);
    }
  throw BadInput("no scene \"" + name + "\"" + nearText(name, names) + "; `avbd scenes` lists them");
}

}  // namespace avbd::cli
