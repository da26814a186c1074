// POSIX calls, repeated until all bytes are through.
#include "io/record/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "io/file_error.h"

namespace avbd::record {

FileBytes::FileBytes(const std::filesystem::path& path, Access access) : name_(path.string()) {
  const int flags = access == Access::Read     ? O_RDONLY
                    : access == Access::Create ? O_RDWR | O_CREAT | O_TRUNC | O_APPEND
                                               : O_RDWR | O_APPEND;
  file_ = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
  if (file_ < 0) fail(errno);
  struct stat facts {};
  const int failed = ::fstat(file_, &facts) != 0 ? errno : S_ISDIR(facts.st_mode) ? EISDIR : 0;
  if (failed == 0) return;
  ::close(file_);
  fail(failed);
}

FileBytes::~FileBytes() {
  if (file_ >= 0) ::close(file_);
}

FileBytes::FileBytes(FileBytes&& other) noexcept
    : name_(std::move(other.name_)), file_(std::exchange(other.file_, -1)) {}

FileBytes& FileBytes::operator=(FileBytes&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(file_, other.file_);
  return *this;
}

bool FileBytes::isAt(const std::filesystem::path& path) const {
  struct stat here {
  }, there{};
  if (::fstat(file_, &here) != 0 || ::stat(path.c_str(), &there) != 0) return true;
  return here.st_dev == there.st_dev && here.st_ino == there.st_ino;
}

uint64_t FileBytes::size() const {
  struct stat facts {};
  if (::fstat(file_, &facts) != 0) fail(errno);
  return static_cast<uint64_t>(facts.st_size);
}

size_t FileBytes::read(uint64_t offset, std::span<uint8_t> out) const {
  size_t done = 0;
  while (done < out.size()) {
    const ssize_t got = ::pread(file_, out.data() + done, out.size() - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(errno);
    if (got == 0) break;
    done += static_cast<size_t>(got);
  }
  return done;
}

void FileBytes::append(std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::write(file_, bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) fail(errno);
    bytes = bytes.subspan(static_cast<size_t>(put));
  }
}

void FileBytes::cut(uint64_t size) {
  if (::ftruncate(file_, static_cast<off_t>(size)) != 0) fail(errno);
}

void FileBytes::fail(int error) const { throw FileError(name_ + ": " + std::strerror(error), name_); }

}  // namespace avbd::record
