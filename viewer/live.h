// Serves the page for a recording over HTTP, and its frames over WebSocket, to any number of browsers on this computer.
// The recording may still grow.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace avbd {

class LiveServer {
 public:
  /// Listens on 127.0.0.1; port 0 takes one that is free. Throws FileError for what is no recording, and
  /// std::runtime_error if the port cannot be had. Serves in a thread of its own until destroyed.
  LiveServer(const std::filesystem::path& recording, uint16_t port);
  /// Only takes the port: who asks waits until show() says what there is to see.
  explicit LiveServer(uint16_t port);
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  /// Once. Throws FileError for what is no recording.
  void show(const std::filesystem::path& recording);
  uint16_t port() const;
  std::string url() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace avbd
