// A file that appears under its name only when it is complete.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace avbd::cli {

/// Writes beside the target and moves the result there; what is not committed is removed. Something that is no regular
/// file (/dev/stdout) is written directly.
class OutputFile {
 public:
  /// `option` names the file in messages. Throws BadInput if the target cannot be written.
  OutputFile(std::string option, const std::filesystem::path& target);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  std::ostream& stream() { return stream_; }
  /// Where the file is or will be, with links followed.
  const std::filesystem::path& target() const { return target_; }
  /// Writes what is left and closes. Throws BadInput if anything could not be written.
  void finish();
  /// After finish(): the file appears under its name.
  void commit();

 private:
  [[noreturn]] void refuse(const std::string& why) const;

  std::string option_;
  std::filesystem::path target_, partial_;  ///< partial_ is empty where the target is written directly
  std::ofstream stream_;
};

}  // namespace avbd::cli
