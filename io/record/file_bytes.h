// A file as bytes at offsets. Everything that fails throws FileError with the file's name and the system's reason.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace avbd::record {

class FileBytes {
 public:
  enum class Access { Read, Create, Extend };
  FileBytes(const std::filesystem::path& path, Access access);
  ~FileBytes();
  FileBytes(FileBytes&& other) noexcept;
  FileBytes& operator=(FileBytes&& other) noexcept;

  const std::string& name() const { return name_; }
  uint64_t size() const;
  /// False if another file has this path now; a path that cannot be asked says nothing.
  bool isAt(const std::filesystem::path& path) const;
  /// Fills `out` as far as the file reaches; returns how many bytes that are.
  size_t read(uint64_t offset, std::span<uint8_t> out) const;
  void append(std::span<const uint8_t> bytes);
  /// Cuts the file; what is appended next stands from here on.
  void cut(uint64_t size);

 private:
  [[noreturn]] void fail(int error) const;

  std::string name_;
  int file_ = -1;
};

}  // namespace avbd::record
