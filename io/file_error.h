// FileError: a scene file that was refused.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace avbd {

/// A file that cannot be read. Thrown before anything is returned. what() reads
/// `tower.xml:12: geom "a": size = "0 1 1": each must be finite and > 0`.
class FileError : public std::runtime_error {
 public:
  explicit FileError(const std::string& message, std::string file = {}, int line = 0)
      : std::runtime_error(message), file_(std::move(file)), line_(line) {}
  const std::string& file() const { return file_; }
  int line() const { return line_; }  ///< from 1; 0 where the file as a whole is meant

 private:
  std::string file_;
  int line_;
};

}  // namespace avbd
