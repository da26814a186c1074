// XML text of a scene: reading files, includes, places for messages.
#include "io/xml_source.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <unordered_set>

namespace avbd::mjcf {

namespace fs = std::filesystem;

std::string quoted(std::string_view text) {
  constexpr size_t kMost = 60;
  std::string out = "\"";
  for (const char c : text.substr(0, kMost)) out += static_cast<unsigned char>(c) < 32 ? ' ' : c;
  if (text.size() > kMost) {
    while ((static_cast<unsigned char>(out.back()) & 0xc0) == 0x80) out.pop_back();  // not half a character
    if (static_cast<unsigned char>(out.back()) >= 0x80) out.pop_back();
    out += "...";
  }
  return out + "\"";
}

namespace {

// Where the text stops being UTF-8 (or holds a zero byte), or npos. Names go on into JSON, which must be UTF-8.
size_t findBadUtf8(std::string_view text) {
  for (size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const int more = byte < 0x80 ? 0 : byte >= 0xc2 && byte < 0xe0 ? 1 : byte >= 0xe0 && byte < 0xf0 ? 2 : 3;
    if (byte == 0 || (byte >= 0x80 && byte < 0xc2) || byte > 0xf4 || i + more >= text.size()) return i;
    uint32_t code = more == 0 ? byte : byte & (0x3f >> more);
    for (int k = 1; k <= more; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      if ((next & 0xc0) != 0x80) return i;
      code = code << 6 | (next & 0x3f);
    }
    const bool overlong = (more == 2 && code < 0x800) || (more == 3 && code < 0x10000);
    if (overlong || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return i;
    i += 1 + more;
  }
  return std::string_view::npos;
}

[[noreturn]] void failFile(const std::string& name, const Elem* includedBy, const XmlSource& source,
                           const std::string& message) {
  if (includedBy) source.fail(*includedBy, "file", includedBy->get("file"), message);
  throw FileError(name + ": " + message, name);
}

std::string limitText() { return "larger than " + std::to_string(XmlSource::kMaxBytes >> 20) + " MiB"; }

}  // namespace

XmlSource XmlSource::fromFile(const fs::path& file) {
  XmlSource source;
  source.folder_ = file.parent_path();
  source.addFile(file, nullptr);
  source.readIncludes(0);
  return source;
}

XmlSource XmlSource::fromText(std::string_view text, std::string_view name) {
  XmlSource source;
  if (text.size() > kMaxBytes) throw FileError(std::string(name) + ": " + limitText(), std::string(name));
  source.paths_.emplace_back();
  source.addText(std::string(text), std::string(name));
  source.readIncludes(0);
  return source;
}

void XmlSource::addFile(const fs::path& path, const Elem* includedBy) {
  const std::string name = path.string();
  std::error_code error;
  if (!fs::exists(path, error)) failFile(name, includedBy, *this, "no such file");
  // Devices and pipes could go on for ever.
  if (!fs::is_regular_file(path, error)) failFile(name, includedBy, *this, "not a regular file");
  const auto size = fs::file_size(path, error);
  if (error) failFile(name, includedBy, *this, "cannot be read");
  if (size > kMaxBytes - bytes_) failFile(name, includedBy, *this, limitText());
  const fs::path canonical = fs::weakly_canonical(path, error);
  const auto known = std::find(paths_.begin(), paths_.end(), canonical);
  if (known != paths_.end()) {
    const bool itself = includedBy && known - paths_.begin() == includedBy->file;
    failFile(name, includedBy, *this,
             itself                    ? "the file includes itself"
             : known == paths_.begin() ? "the main file cannot be included"
                                       : "the file is included more than once");
  }
  std::string text(size, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(text.data(), static_cast<std::streamsize>(size));
  if (!in) failFile(name, includedBy, *this, "cannot be read");
  bytes_ += size;
  paths_.push_back(canonical);
  addText(std::move(text), name);
}

void XmlSource::addText(std::string text, std::string name) {
  auto file = std::make_unique<File>();
  file->name = std::move(name);
  file->text = std::move(text);
  const auto lineAt = [&](size_t offset) {
    const auto it = std::upper_bound(file->lineStarts.begin(), file->lineStarts.end(), offset);
    return static_cast<int>(it - file->lineStarts.begin());
  };
  file->lineStarts.push_back(0);
  for (size_t i = 0; i < file->text.size(); ++i) {
    if (file->text[i] == '\n') file->lineStarts.push_back(i + 1);
  }
  const auto refuse = [&](size_t offset, const std::string& message) {
    const int line = lineAt(offset);
    throw FileError(file->name + ":" + std::to_string(line) + ": " + message, file->name, line);
  };
  const size_t bad = findBadUtf8(file->text);
  if (bad != std::string::npos) refuse(bad, "not text in UTF-8");
  const pugi::xml_parse_result result = file->document.load_buffer_inplace(file->text.data(), file->text.size(),
                                                                           pugi::parse_default, pugi::encoding_utf8);
  if (!result) refuse(static_cast<size_t>(std::max<ptrdiff_t>(result.offset, 0)), result.description());
  const pugi::xml_node first = file->document.document_element();
  for (pugi::xml_node n = first.next_sibling(); n; n = n.next_sibling()) {
    if (n.type() == pugi::node_element) {
      refuse(static_cast<size_t>(n.offset_debug()), "a second root element <" + std::string(n.name()) + ">");
    }
  }
  files_.push_back(std::move(file));
}

void XmlSource::checkAttributesOnce(Elem elem) const {
  std::unordered_set<std::string_view> seen;
  if (elem.node.first_attribute() == elem.node.last_attribute()) return;
  constexpr size_t kMost = 1000;  // attributes are looked up one by one
  for (const pugi::xml_attribute a : elem.node.attributes()) {
    if (seen.size() == kMost) fail(elem, "more than 1000 attributes");
    if (!seen.insert(a.name()).second) fail(elem, a.name(), a.value(), "the attribute is given twice");
  }
}

void XmlSource::readIncludes(uint32_t file) {
  // A work list, not recursion: files may nest elements deeper than the C stack allows.
  for (; file < files_.size(); ++file) {
    const pugi::xml_node root = files_[file]->document.document_element();
    pugi::xml_node n = root;
    while (n) {
      if (n.type() == pugi::node_element) {
        const Elem elem{n, file};
        checkAttributesOnce(elem);
        if (elem.name() == "include" && n != root) include(elem);
      }
      if (n.first_child()) {
        n = n.first_child();
        continue;
      }
      while (n && n != root && !n.next_sibling()) n = n.parent();
      if (!n || n == root) break;
      n = n.next_sibling();
    }
  }
}

void XmlSource::include(Elem elem) {
  if (!elem.has("file") || elem.get("file").empty()) fail(elem, "file is missing: must name a file");
  if (paths_[0].empty()) fail(elem, "file", elem.get("file"), "text that is not a file cannot include files");
  const fs::path asked(std::string(elem.get("file")));
  const uint32_t index = static_cast<uint32_t>(files_.size());
  addFile(asked.is_absolute() ? asked : folder_ / asked, &elem);
  included_[elem.node.internal_object()] = index;
}

std::optional<fs::path> XmlSource::folder() const { return paths_[0].empty() ? std::optional<fs::path>{} : folder_; }

Elem XmlSource::root() const { return {files_[0]->document.document_element(), 0}; }

std::vector<Elem> XmlSource::children(Elem parent) const {
  std::vector<Elem> out;
  std::vector<Elem> rest;  // where to go on after an include
  Elem at{parent.node.first_child(), parent.file};
  for (;;) {
    if (!at.node) {
      if (rest.empty()) return out;
      at = rest.back();
      rest.pop_back();
      continue;
    }
    const Elem now = at;
    at.node = at.node.next_sibling();
    if (now.node.type() != pugi::node_element) continue;
    const auto found = included_.find(now.node.internal_object());
    if (found == included_.end()) {
      out.push_back(now);
    } else {
      rest.push_back(at);
      at = {files_[found->second]->document.document_element().first_child(), found->second};
    }
  }
}

int XmlSource::line(Elem elem) const {
  const File& file = *files_[elem.file];
  const size_t offset = static_cast<size_t>(std::max<ptrdiff_t>(elem.node.offset_debug(), 0));
  const auto it = std::upper_bound(file.lineStarts.begin(), file.lineStarts.end(), offset);
  return static_cast<int>(it - file.lineStarts.begin());
}

std::string XmlSource::label(Elem elem) const {
  const auto named = [](pugi::xml_node n) {
    const char* key = std::strcmp(n.name(), "default") == 0 ? "class" : "name";
    const pugi::xml_attribute name = n.attribute(key);
    std::string out(std::string_view(n.name()).substr(0, 60));
    return name.empty() ? out : out + " " + quoted(name.value());
  };
  const pugi::xml_node parent = elem.node.parent();
  const bool showParent = !elem.has("name") && parent.type() == pugi::node_element && parent.parent().parent();
  return (showParent ? named(parent) + " > " : "") + named(elem.node);
}

std::string XmlSource::place(Elem elem) const { return fileName(elem) + ":" + std::to_string(line(elem)); }

std::string XmlSource::where(Elem elem) const { return place(elem) + ": " + label(elem); }

void XmlSource::fail(Elem elem, const std::string& message) const {
  throw FileError(where(elem) + ": " + message, fileName(elem), line(elem));
}

void XmlSource::fail(Elem elem, std::string_view attribute, std::string_view value, const std::string& range) const {
  fail(elem, std::string(attribute.substr(0, 60)) + " = " + quoted(value) + ": " + range);
}

}  // namespace avbd::mjcf
