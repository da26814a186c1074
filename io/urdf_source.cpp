// The XML text of a URDF file.
#include "io/urdf_source.h"

#include <algorithm>
#include <fstream>

#include "io/mjcf_values.h"

namespace avbd::urdf {

namespace fs = std::filesystem;

namespace {

void appendUtf8(std::string& out, uint32_t code) {
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xc0 | code >> 6);
    out += static_cast<char>(0x80 | (code & 0x3f));
  } else if (code < 0x10000) {
    out += static_cast<char>(0xe0 | code >> 12);
    out += static_cast<char>(0x80 | (code >> 6 & 0x3f));
    out += static_cast<char>(0x80 | (code & 0x3f));
  } else {
    out += static_cast<char>(0xf0 | code >> 18);
    out += static_cast<char>(0x80 | (code >> 12 & 0x3f));
    out += static_cast<char>(0x80 | (code >> 6 & 0x3f));
    out += static_cast<char>(0x80 | (code & 0x3f));
  }
}

std::string fromUtf16(std::string_view text, bool bigEndian, const std::string& name) {
  std::string out;
  const auto unit = [&](size_t i) {
    const auto a = static_cast<unsigned char>(text[i]), b = static_cast<unsigned char>(text[i + 1]);
    return static_cast<uint32_t>(bigEndian ? a << 8 | b : b << 8 | a);
  };
  for (size_t i = 0; i < text.size(); i += 2) {
    if (i + 1 == text.size()) throw FileError(name + ": UTF-16 that ends within a character", name);
    uint32_t code = unit(i);
    if (code >= 0xd800 && code < 0xdc00 && i + 3 < text.size() && unit(i + 2) >> 10 == 0x37) {
      code = 0x10000 + ((code & 0x3ff) << 10) + (unit(i + 2) & 0x3ff);
      i += 2;
    } else if (code >= 0xd800 && code < 0xe000) {
      throw FileError(name + ": UTF-16 with half a character", name);
    }
    appendUtf8(out, code);
  }
  return out;
}

std::string fromLatin1(std::string_view text) {
  std::string out;
  for (const char c : text) appendUtf8(out, static_cast<unsigned char>(c));
  return out;
}

// What <?xml ... encoding="..."?> says, in lower case.
std::string declaredEncoding(std::string_view text) {
  if (!text.starts_with("<?xml")) return {};
  const std::string_view head = text.substr(0, std::min(text.find("?>"), size_t{200}));
  const size_t at = head.find("encoding");
  const size_t open = at == std::string_view::npos ? at : head.find_first_of("\"'", at);
  if (open == std::string_view::npos) return {};
  const size_t close = head.find(head[open], open + 1);
  if (close == std::string_view::npos) return {};
  std::string out(head.substr(open + 1, close - open - 1));
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

std::string decoded(std::string text, const std::string& name, Notes& notes) {
  const std::string_view head(text);
  if (head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff")) {
    notes.add(name, "text in UTF-16");
    return fromUtf16(head.substr(2), head[0] == '\xfe', name);
  }
  const std::string encoding = declaredEncoding(head);
  for (const char* latin : {"iso-8859-1", "latin1", "latin-1", "windows-1252", "iso-8859-15"}) {
    if (encoding != latin) continue;
    const bool ascii = std::all_of(text.begin(), text.end(), [](char c) { return (c & 0x80) == 0; });
    if (!ascii) notes.add(name, "text in " + encoding + ", read as ISO-8859-1");
    return ascii ? text : fromLatin1(text);
  }
  return text;
}

// The reader of XML serves MJCF and follows <include>, which URDF does not have but SDF inside <gazebo> does.
void hideIncludes(std::string& text) {
  for (const std::string_view tag : {"<include", "</include"}) {
    for (size_t at = text.find(tag); at != std::string::npos; at = text.find(tag, at + 1)) {
      text[at + tag.size() - 7] = 'I';
    }
  }
}

// Next element of the tree below `root` in the order of the file.
pugi::xml_node after(pugi::xml_node node, pugi::xml_node root) {
  if (node.first_child()) return node.first_child();
  while (node && node != root && !node.next_sibling()) node = node.parent();
  return node == root ? pugi::xml_node{} : node.next_sibling();
}

constexpr const char* kExpand = "xacro is not expanded here: run `xacro FILE > robot.urdf` first";

void refuseXacro(const Source& source) {
  const Elem root = source.root();
  for (pugi::xml_node n = root.node; n; n = after(n, root.node)) {
    const std::string_view name = n.name();
    const bool old = n.parent() == root.node && (name == "property" || name == "macro");
    if (name.starts_with("xacro:") || old) source.fail({n, 0}, kExpand);
  }
}

void refuseOtherRoots(const Source& source) {
  const Elem root = source.root();
  const std::string_view name = root.name();
  if (name == "robot") return;
  const std::string start = "root element <" + std::string(name.substr(0, 60)) + ">: ";
  if (name == "sdf" || name == "gazebo" || name == "model" || name == "world") {
    source.fail(root, start + "this is SDF, Gazebo's own format, not URDF");
  }
  if (name == "mujoco") source.fail(root, start + "this is MJCF, not URDF");
  if (name == "COLLADA") source.fail(root, start + "this is a mesh in COLLADA, not URDF");
  source.fail(root, start + "a URDF file has the root element <robot>");
}

}  // namespace

Source Source::fromText(std::string text, const std::string& name, Notes& notes) {
  text = decoded(std::move(text), name, notes);
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) throw FileError(name + ": the file is empty", name);
  hideIncludes(text);
  Source source(mjcf::XmlSource::fromText(text, name));
  refuseOtherRoots(source);
  refuseXacro(source);
  return source;
}

Source Source::fromFile(const fs::path& file, Notes& notes) {
  const std::string name = file.string();
  const auto refuse = [&](const std::string& message) { throw FileError(name + ": " + message, name); };
  std::error_code error;
  if (!fs::exists(file, error)) refuse("no such file");
  if (!fs::is_regular_file(file, error)) refuse("not a regular file");  // devices and pipes could go on for ever
  const auto size = fs::file_size(file, error);
  if (error) refuse("cannot be read");
  if (size > mjcf::XmlSource::kMaxBytes) {
    refuse("larger than " + std::to_string(mjcf::XmlSource::kMaxBytes >> 20) + " MiB");
  }
  std::string text(size, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(text.data(), static_cast<std::streamsize>(size));
  if (!in) refuse("cannot be read");
  if (text.starts_with("\x1f\x8b")) refuse("compressed by gzip: unpack it first");
  return fromText(std::move(text), name, notes);
}

std::optional<Elem> Source::only(Elem parent, std::string_view name) const {
  std::optional<Elem> out;
  for (const Elem& child : children(parent)) {
    if (child.name() != name) continue;
    if (out) fail(child, "the element is given twice");
    out = child;
  }
  return out;
}

std::string Source::where(Elem elem) const {
  std::string label;
  int depth = 0;
  for (pugi::xml_node n = elem.node; n.parent().parent() || n == elem.node; n = n.parent()) {
    const pugi::xml_attribute name = n.attribute(n.attribute("name").empty() ? "reference" : "name");
    std::string part(std::string_view(n.name()).substr(0, 60));
    if (!name.empty()) part += " " + mjcf::quoted(name.value());
    if (++depth <= 4) {
      label = label.empty() ? part : part + " > " + label;
    } else if (!n.parent().parent().parent()) {
      label = part + " > ... > " + label;  // what stands between says little
    }
    if (!n.parent().parent()) break;
  }
  return place(elem) + ": " + label;
}

void Source::fail(Elem elem, const std::string& message) const {
  throw FileError(where(elem) + ": " + message, xml_.fileName(elem), line(elem));
}

void Source::fail(Elem elem, std::string_view attribute, std::string_view value, const std::string& range) const {
  fail(elem, std::string(attribute.substr(0, 60)) + " = " + mjcf::quoted(value) + ": " + range);
}

std::string_view Source::text(Elem elem, const char* attribute) const {
  const std::string_view value = elem.get(attribute);
  if (value.find("${") != std::string_view::npos || value.find("$(") != std::string_view::npos) {
    fail(elem, attribute, value, kExpand);
  }
  return value;
}

std::string Source::requiredText(Elem elem, const char* attribute) const {
  const std::string_view value = text(elem, attribute);
  if (!elem.has(attribute)) fail(elem, std::string(attribute) + " is missing: must be given");
  if (value.empty()) fail(elem, attribute, value, "must not be empty");
  return std::string(value);
}

std::optional<std::vector<double>> Source::numbers(Elem elem, const char* attribute, size_t count) const {
  if (!elem.has(attribute)) return {};
  const std::string_view value = text(elem, attribute);
  const std::string wanted = "must be " + std::to_string(count) + (count == 1 ? " number" : " numbers");
  std::vector<double> out;
  mjcf::NumberFault fault;
  if (!mjcf::readNumbers(value, count, out, fault)) {
    fail(elem, attribute, value, out.size() == count ? wanted : mjcf::quoted(fault.token) + " " + fault.reason);
  }
  if (out.size() != count) fail(elem, attribute, value, wanted);
  return out;
}

double Source::number(Elem elem, const char* attribute, double otherwise) const {
  const auto values = numbers(elem, attribute, 1);
  return values ? values->front() : otherwise;
}

double Source::requiredNumber(Elem elem, const char* attribute) const {
  const auto values = numbers(elem, attribute, 1);
  if (!values) fail(elem, std::string(attribute) + " is missing: must be 1 number");
  return values->front();
}

Vec3d Source::vector(Elem elem, const char* attribute, Vec3d otherwise) const {
  const auto values = numbers(elem, attribute, 3);
  return values ? Vec3d{(*values)[0], (*values)[1], (*values)[2]} : otherwise;
}

}  // namespace avbd::urdf
