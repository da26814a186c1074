// The JSON head of a page: all of a recording but its frames' poses, contacts and reactions.
#pragma once

#include <ostream>
#include <string_view>
#include <vector>

#include "io/record/recording.h"
#include "viewer/encode.h"

namespace avbd::page {

/// Fields, one after the other.
class Head {
 public:
  explicit Head(std::ostream& out) : out_(out) { out_ << "{\"version\":1"; }
  void text(const char* name, std::string_view value) { out_ << ",\"" << name << "\":" << jsonText(value); }
  template <class T>
  void numbers(const char* name, const std::vector<T>& value) {
    out_ << ",\n\"" << name << "\":\"" << base64Of(value) << '"';
  }
  template <class List, class Print>
  void list(const char* name, const List& items, Print print) {
    out_ << ",\n\"" << name << "\":[";
    const char* comma = "";
    for (const auto& item : items) {
      out_ << comma;
      print(out_, item);
      comma = ",";
    }
    out_ << ']';
  }
  ~Head() { out_ << "}\n"; }

 private:
  std::ostream& out_;
};

void writeJoints(Head& head, const Recording& r);

inline void append(std::vector<float>& out, Vec3 v) { out.insert(out.end(), {v.x, v.y, v.z}); }
inline void append(std::vector<float>& out, Quat q) { out.insert(out.end(), {q.w, q.x, q.y, q.z}); }
inline void append(std::vector<double>& out, Vec3d v) { out.insert(out.end(), {v.x, v.y, v.z}); }

}  // namespace avbd::page
