// MJCF default classes.
#include "io/mjcf_defaults.h"

#include <algorithm>
#include <iterator>

#include "io/mjcf_schema.h"

namespace avbd::mjcf {

namespace {

void noteUse(const XmlSource& source, Elem elem, std::string_view element, const Attr& attr, Use use, Notes& notes) {
  if (use == Use::NotedUnless0) {
    std::vector<double> numbers;
    NumberFault fault;
    readNumbers(attr.value, 8, numbers, fault);
    if (std::all_of(numbers.begin(), numbers.end(), [](double v) { return v == 0; })) return;
  } else if (use != Use::Noted) {
    return;
  }
  notes.add(source.where(elem), "attribute " + std::string(attr.name) + " is not used", element);
}

// What an element can only say of itself. For meshes that is all their data, as in MuJoCo: every mesh of the class
// would hold a copy.
bool isOwnOnly(std::string_view element, std::string_view attribute) {
  constexpr std::string_view kMeshData[] = {"file",     "content_type", "vertex",  "face",        "normal",
                                            "texcoord", "refpos",       "refquat", "smoothnormal"};
  if (attribute == "name" || attribute == "class") return true;
  return element == "mesh" && std::find(std::begin(kMeshData), std::end(kMeshData), attribute) != std::end(kMeshData);
}

}  // namespace

void checkAttributes(const XmlSource& source, Elem elem, std::string_view element, Notes& notes) {
  for (const pugi::xml_attribute a : elem.node.attributes()) {
    const Attr attr{a.name(), a.value(), elem};
    const AttributeRule* rule = findRule(element, attr.name);
    if (!rule) {
      notes.add(source.where(elem), "unknown attribute " + quoted(attr.name), element);
      continue;
    }
    if (rule->most > 0) {
      Attributes(source, elem, {attr})
          .numbers(attr.name, static_cast<size_t>(rule->least), static_cast<size_t>(rule->most));
    }
    noteUse(source, elem, element, attr, rule->use, notes);
  }
}

int Defaults::open(Elem elem, int parent) {
  const std::string name(elem.get("class"));
  const bool top = parent < 0;
  if (top) {
    // MuJoCo gives its one top class this name; here it keeps the names that it had before, too.
    if (byName_.emplace(name.empty() ? "main" : name, kMain).first->second == kMain) return kMain;
    source_.fail(elem, "class", name, "a default class of this name exists");
  }
  if (name.empty()) source_.fail(elem, "class is missing: a default inside a default must name its class");
  if (classes_.size() >= kMostClasses) source_.fail(elem, "more than 10000 default classes");
  const int index = static_cast<int>(classes_.size());
  if (!byName_.emplace(name, index).second) source_.fail(elem, "class", name, "a default class of this name exists");
  classes_.push_back({name, classes_[static_cast<size_t>(parent)].settings});
  return index;
}

void Defaults::read(Elem top, Notes& notes) {
  // A work list, not recursion: classes may nest deeper than the C stack allows. Each entry is already open.
  struct Open {
    Elem elem;
    int cls;
  };
  std::vector<Open> todo{{top, open(top, -1)}};
  while (!todo.empty()) {
    const Open now = todo.back();
    todo.pop_back();
    checkAttributes(source_, now.elem, "default", notes);
    readSettings(now.elem, classes_[static_cast<size_t>(now.cls)], notes);
    // A class inherits all that its parent sets, also what stands below it in the file.
    for (const Elem child : source_.children(now.elem)) {
      if (child.name() == "default") todo.push_back({child, open(child, now.cls)});
    }
  }
}

void Defaults::readSettings(Elem elem, Class& cls, Notes& notes) {
  for (const Elem child : source_.children(elem)) {
    const std::string_view name = child.name();
    const Section section = sectionOf("default", name);
    if (section == Section::Unknown) {
      notes.add(source_.where(child), "unknown element", name);
    }
    if (section != Section::Read || name == "default") continue;
    checkAttributes(source_, child, name, notes);
    std::vector<Attr>& known = cls.settings[std::string(familyOf(name))];
    for (const pugi::xml_attribute a : child.node.attributes()) {
      const Attr attr{a.name(), a.value(), child};
      if (!findRule(name, attr.name)) continue;
      if (isOwnOnly(name, attr.name)) source_.fail(child, attr.name, attr.value, "not allowed in a default");
      const auto it = std::find_if(known.begin(), known.end(), [&](const Attr& k) { return k.name == attr.name; });
      if (it != known.end()) {
        *it = attr;
      } else {
        known.push_back(attr);
      }
    }
  }
}

int Defaults::find(Elem elem, std::string_view attribute) const {
  const std::string_view name = elem.get(std::string(attribute).c_str());
  const auto it = byName_.find(name);
  if (it == byName_.end() && name == "main") return kMain;
  if (it == byName_.end()) source_.fail(elem, attribute, name, "no default class has this name");
  return it->second;
}

Attributes Defaults::resolve(Elem elem, std::string_view element, int cls) const {
  std::vector<Attr> out;
  for (const pugi::xml_attribute a : elem.node.attributes()) {
    if (findRule(element, a.name())) out.push_back({a.name(), a.value(), elem});
  }
  if (elem.has("class")) cls = find(elem, "class");
  const Settings& settings = classes_[static_cast<size_t>(cls)].settings;
  if (const auto it = settings.find(element); it != settings.end()) {
    const size_t own = out.size();
    for (const Attr& attr : it->second) {
      const auto same = [&](const Attr& k) { return k.name == attr.name; };
      if (std::none_of(out.begin(), out.begin() + static_cast<ptrdiff_t>(own), same)) out.push_back(attr);
    }
  }
  return Attributes(source_, elem, std::move(out));
}

}  // namespace avbd::mjcf
