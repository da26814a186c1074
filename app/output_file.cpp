// Writing beside the target, then moving.
#include "app/output_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "app/failure.h"

namespace avbd::cli {

namespace fs = std::filesystem;

OutputFile::OutputFile(std::string option, const fs::path& target) : option_(std::move(option)), target_(target) {
  std::error_code failed;
  if (const fs::path real = fs::weakly_canonical(target, failed); !failed) target_ = real;
  if (target_.filename().empty() || fs::is_directory(target_, failed)) refuse("is a directory");
  const bool exists = fs::exists(target_, failed);
  if (exists && access(target_.c_str(), W_OK) != 0) refuse(std::strerror(errno));
  const bool direct = exists && !fs::is_regular_file(target_, failed);
  if (!direct) {
    partial_ = target_;
    partial_ += ".partial" + std::to_string(getpid());
  }
  errno = 0;
  stream_.open(direct ? target_ : partial_, std::ios::binary | std::ios::trunc);
  if (!stream_) {
    partial_.clear();
    refuse(errno != 0 ? std::strerror(errno) : "cannot be written");
  }
}

OutputFile::~OutputFile() {
  if (partial_.empty()) return;
  stream_.close();
  std::error_code ignored;
  fs::remove(partial_, ignored);
}

void OutputFile::finish() {
  errno = 0;
  stream_.close();
  if (!stream_) refuse(errno != 0 ? std::strerror(errno) : "could not be written in full");
}

void OutputFile::commit() {
  if (partial_.empty()) return;
  std::error_code failed;
  fs::rename(partial_, target_, failed);
  if (failed) refuse(failed.message());
  partial_.clear();
}

void OutputFile::refuse(const std::string& why) const { throw BadInput(option_ + " " + target_.string() + ": " + why); }

}  // namespace avbd::cli
