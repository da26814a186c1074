// Cached decompositions (hull_cache.h). A file: magic, version, key, hash of the rest, then the result as little-endian
// numbers: hulls as vertices, to be made again and compared with the hash that they had.
#include "io/hull_cache.h"

#include <avbd/error.h>

#include <array>
#include <bit>
#include <cstring>
#include <ctime>
#include <fstream>
#include <optional>
#include <system_error>
#include <vector>

namespace avbd {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::array<char, 8> kMagic{'A', 'V', 'B', 'D', 'H', 'U', 'L', 'L'};
/// Of file and method: a changed decomposition must not find what the old one left.
constexpr uint32_t kVersion = 2;
constexpr size_t kMaxBytes = 64u << 20;

/// 64 bits over bytes; not against adversaries.
uint64_t hashOf(std::span<const char> bytes, uint64_t seed) {
  uint64_t h = seed ^ (bytes.size() * 0x9e3779b97f4a7c15u);
  const auto mix = [&](uint64_t word) {
    h = (h ^ word) * 0xff51afd7ed558ccdu;
    h ^= h >> 32;
  };
  size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    uint64_t word;
    std::memcpy(&word, bytes.data() + i, 8);
    mix(word);
  }
  uint64_t tail = 0;
  if (i < bytes.size()) std::memcpy(&tail, bytes.data() + i, bytes.size() - i);
  mix(tail);
  return (h ^ (h >> 29)) * 0xc4ceb9fe1a85ec53u;
}

template <class T>
std::span<const char> bytesOf(std::span<const T> all) {
  return {reinterpret_cast<const char*>(all.data()), all.size_bytes()};
}

struct Options {
  int32_t maxHulls, resolution, maxVerticesPerHull, seal;
  float maxError;
  uint32_t version;
};

uint64_t keyOf(const DecomposeDef& def) {
  const Options options{def.maxHulls, def.resolution, def.maxVerticesPerHull, def.seal, def.maxError, kVersion};
  const uint64_t seed = hashOf(bytesOf(def.vertices), hashOf(bytesOf(def.triangles), 1));
  return hashOf({reinterpret_cast<const char*>(&options), sizeof options}, seed);
}

struct Head {
  std::array<char, 8> magic = kMagic;
  uint64_t key = 0, bodyHash = 0, bodySize = 0;
};

class Writer {
 public:
  template <class T>
  void put(const T& value) {
    const char* p = reinterpret_cast<const char*>(&value);
    bytes.insert(bytes.end(), p, p + sizeof value);
  }
  std::vector<char> bytes;
};

class Reader {
 public:
  explicit Reader(std::span<const char> bytes) : rest_(bytes) {}
  template <class T>
  bool get(T& value) {
    if (rest_.size() < sizeof value) return false;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_ = rest_.subspan(sizeof value);
    return true;
  }
  bool atEnd() const { return rest_.empty(); }

 private:
  std::span<const char> rest_;
};

std::vector<char> bodyOf(const Decomposition& d) {
  Writer w;
  w.put(d.error), w.put(d.errorFound), w.put(d.volume), w.put(d.tolerance), w.put(d.openEdges);
  w.put(static_cast<uint32_t>(d.hulls.size()));
  for (const auto& hull : d.hulls) {
    w.put(hull->contentHash());
    w.put(static_cast<uint32_t>(hull->vertices().size()));
    for (const Vec3& v : hull->vertices()) w.put(v);
  }
  return std::move(w.bytes);
}

std::optional<Decomposition> fromBody(std::span<const char> bytes) {
  Reader r(bytes);
  Decomposition d;
  uint32_t count = 0;
  if (!(r.get(d.error) && r.get(d.errorFound) && r.get(d.volume) && r.get(d.tolerance) && r.get(d.openEdges)))
    return {};
  if (!r.get(count) || count > 2048) return {};
  for (uint32_t i = 0; i < count; ++i) {
    uint64_t hash = 0;
    uint32_t vertices = 0;
    if (!r.get(hash) || !r.get(vertices) || vertices > 255) return {};
    std::vector<Vec3> points(vertices);
    for (Vec3& p : points) {
      if (!r.get(p)) return {};
    }
    try {
      d.hulls.push_back(makeHull({.points = points, .tolerance = d.tolerance, .maxVertices = 255}));
    } catch (const Error&) {
      return {};
    }
    if (d.hulls.back()->contentHash() != hash) return {};
  }
  if (!r.atEnd()) return {};
  return d;
}

/// The result in the file, or why there is none; an absent file needs no reason.
std::optional<Decomposition> load(const std::filesystem::path& file, uint64_t key, std::string& why) {
  std::error_code missing;
  const uintmax_t size = std::filesystem::file_size(file, missing);
  if (missing) return {};
  const auto refuse = [&](const char* reason) {
    why = file.string() + ": " + reason + "; made anew";
    return std::nullopt;
  };
  if (size < sizeof(Head) || size > kMaxBytes) return refuse("not a file of this cache");
  std::vector<char> bytes(size);
  std::ifstream in(file, std::ios::binary);
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size))) return refuse("cannot be read");
  Head head;
  std::memcpy(&head, bytes.data(), sizeof head);
  const std::span<const char> body = std::span<const char>(bytes).subspan(sizeof head);
  if (head.magic != kMagic) return refuse("not a file of this cache");
  if (head.key != key) return refuse("of another mesh or other options");
  if (head.bodySize != body.size() || head.bodyHash != hashOf(body, key)) return refuse("damaged");
  std::optional<Decomposition> result = fromBody(body);
  if (!result) return refuse("of another version");
  return result;
}

/// Whole or not at all: written beside the file, then renamed.
std::string store(const Decomposition& d, const std::filesystem::path& file, uint64_t key) {
  const std::vector<char> body = bodyOf(d);
  Head head;
  head.key = key;
  head.bodyHash = hashOf(body, key);
  head.bodySize = body.size();
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  // Two that write at once must not share it; whoever renames last leaves the same content.
  const auto unique = reinterpret_cast<uintptr_t>(&head) ^ hashOf(body, static_cast<uint64_t>(std::time(nullptr)));
  std::filesystem::path part = file;
  part += "." + std::to_string(unique) + ".part";
  std::ofstream out(part, std::ios::binary);
  out.write(reinterpret_cast<const char*>(&head), sizeof head);
  out.write(body.data(), static_cast<std::streamsize>(body.size()));
  out.close();
  if (out) std::filesystem::rename(part, file, failed);
  if (out && !failed) return {};
  std::filesystem::remove(part, failed);
  return file.string() + ": cannot be written";
}

}  // namespace

std::filesystem::path cacheFile(const DecomposeDef& def, const std::filesystem::path& folder) {
  static constexpr char kDigits[] = "0123456789abcdef";
  const uint64_t key = keyOf(def);
  std::string name;
  for (int i = 60; i >= 0; i -= 4) name += kDigits[key >> i & 15];
  return folder / (name + ".hulls");
}

CachedDecomposition decomposeCached(const DecomposeDef& def, const std::filesystem::path& folder) {
  const std::filesystem::path file = cacheFile(def, folder);
  const uint64_t key = keyOf(def);
  CachedDecomposition cached;
  if (std::optional<Decomposition> loaded = load(file, key, cached.note)) {
    cached.result = std::move(*loaded);
    cached.found = true;
    return cached;
  }
  cached.result = decompose(def);
  const std::string unwritten = store(cached.result, file, key);
  if (!unwritten.empty()) cached.note = unwritten;
  return cached;
}

}  // namespace avbd
