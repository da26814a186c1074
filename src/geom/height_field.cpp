// Height fields: checks, accessors, the pyramid of ranges (height_field.h).
#include <avbd/error.h>
#include <avbd/height_field.h>

#include <algorithm>
#include <cfloat>

#include "base/format.h"
#include "base/hash.h"
#include "geom/height_field_parts.h"

namespace avbd {
namespace {

using Parts = HeightFieldData::Parts;

constexpr int kMaxSide = 32768;
constexpr float kMaxHeight = 1e6f;

[[noreturn]] void refuse(std::string field, std::string value, std::string range) {
  throw Error("HeightFieldDef", std::move(field), std::move(value), std::move(range));
}

void checkSide(const char* field, int value) {
  if (value < 2 || value > kMaxSide) refuse(field, toText(value), "must be in 2 .. " + toText(kMaxSide));
}

void checkLength(const char* field, float value, bool mayBeZero) {
  if (mayBeZero && value == 0) return;
  if (value >= 1e-6f && value <= kMaxHeight) return;
  refuse(field, toText(value),
         mayBeZero ? "must be 0 or at least 1e-06, and at most 1e+06" : "must be at least 1e-06 and at most 1e+06");
}

void check(const HeightFieldDef& def) {
  checkSide("columns", def.columns);
  checkSide("rows", def.rows);
  checkLength("spacingX", def.spacingX, false);
  checkLength("spacingZ", def.spacingZ, false);
  checkLength("thickness", def.thickness, true);
  const size_t samples = static_cast<size_t>(def.columns) * static_cast<size_t>(def.rows);
  const size_t cells = static_cast<size_t>(def.columns - 1) * static_cast<size_t>(def.rows - 1);
  if (def.heights.size() != samples) {
    refuse("heights", toText(def.heights.size()) + " heights", "must be columns x rows = " + toText(samples));
  }
  for (size_t i = 0; i < samples; ++i) {
    if (def.heights[i] >= -kMaxHeight && def.heights[i] <= kMaxHeight) continue;
    refuse("heights[" + toText(i) + "]", toText(def.heights[i]), "must be finite and within +-1e+06");
  }
  if (!def.materials.empty() && def.materials.size() != cells) {
    refuse("materials", toText(def.materials.size()) + " materials",
           "must be empty or one for each of the " + toText(cells) + " cells");
  }
}

void grow(Parts::Block& to, Parts::Block by) {
  to.low = std::min(to.low, by.low);
  to.high = std::max(to.high, by.high);
}

constexpr Parts::Block kOpen{FLT_MAX, -FLT_MAX};

Parts::Level emptyLevel(int columns, int rows) {
  return {columns, rows, std::vector<Parts::Block>(static_cast<size_t>(columns) * static_cast<size_t>(rows), kOpen)};
}

Parts::Block& blockAt(Parts::Level& level, int column, int row) {
  return level.blocks[static_cast<size_t>(row) * static_cast<size_t>(level.columns) + static_cast<size_t>(column)];
}

void buildLevels(Parts& parts) {
  constexpr int kShift = Parts::kBlockShift;
  parts.levels.push_back(emptyLevel(((parts.cellColumns() - 1) >> kShift) + 1, ((parts.cellRows() - 1) >> kShift) + 1));
  for (int r = 0; r < parts.cellRows(); ++r) {
    for (int c = 0; c < parts.cellColumns(); ++c) {
      if (!parts.isClosed(c, r)) continue;
      const float h[4] = {parts.height(c, r), parts.height(c + 1, r), parts.height(c, r + 1),
                          parts.height(c + 1, r + 1)};
      grow(blockAt(parts.levels[0], c >> kShift, r >> kShift),
           {*std::min_element(h, h + 4), *std::max_element(h, h + 4)});
    }
  }
  while (parts.levels.back().columns > 1 || parts.levels.back().rows > 1) {
    Parts::Level& below = parts.levels.back();
    Parts::Level level = emptyLevel((below.columns + 1) / 2, (below.rows + 1) / 2);
    for (int r = 0; r < below.rows; ++r) {
      for (int c = 0; c < below.columns; ++c) grow(blockAt(level, c / 2, r / 2), blockAt(below, c, r));
    }
    parts.levels.push_back(std::move(level));
  }
}

}  // namespace

HeightFieldData::HeightFieldData(std::unique_ptr<const Parts> parts) : parts_(std::move(parts)) {}
HeightFieldData::~HeightFieldData() = default;
int HeightFieldData::columns() const { return parts_->columns; }
int HeightFieldData::rows() const { return parts_->rows; }
float HeightFieldData::spacingX() const { return parts_->spacingX; }
float HeightFieldData::spacingZ() const { return parts_->spacingZ; }
float HeightFieldData::thickness() const { return parts_->thickness; }
float HeightFieldData::height(int column, int row) const { return parts_->height(column, row); }
uint16_t HeightFieldData::cellMaterial(int column, int row) const { return parts_->material(column, row); }
Vec3 HeightFieldData::lower() const { return parts_->lower; }
Vec3 HeightFieldData::upper() const { return parts_->upper; }
uint64_t HeightFieldData::contentHash() const { return parts_->hash; }

size_t HeightFieldData::bytes() const {
  size_t sum = sizeof(Parts) + parts_->heights.size() * sizeof(float) + parts_->materials.size() * sizeof(uint16_t);
  for (const Parts::Level& level : parts_->levels) sum += sizeof(level) + level.blocks.size() * sizeof(Parts::Block);
  return sum;
}

uint32_t HeightFieldData::triangleCount() const {
  return 2 * static_cast<uint32_t>(parts_->cellColumns()) * static_cast<uint32_t>(parts_->cellRows());
}

std::array<Vec3, 3> HeightFieldData::triangle(uint32_t element) const {
  const int cell = static_cast<int>(element / 2), c = cell % parts_->cellColumns(), r = cell / parts_->cellColumns();
  const Vec3 first = parts_->corner(c, r), last = parts_->corner(c + 1, r + 1);
  if (element % 2 == 0) return {first, parts_->corner(c, r + 1), last};
  return {first, last, parts_->corner(c + 1, r)};
}

std::shared_ptr<const HeightFieldData> makeHeightField(const HeightFieldDef& def) {
  check(def);
  auto parts = std::make_unique<Parts>();
  parts->columns = def.columns;
  parts->rows = def.rows;
  parts->spacingX = def.spacingX;
  parts->spacingZ = def.spacingZ;
  parts->thickness = def.thickness > 0 ? def.thickness : std::max(def.spacingX, def.spacingZ);
  parts->heights.assign(def.heights.begin(), def.heights.end());
  parts->materials.assign(def.materials.begin(), def.materials.end());
  const auto [low, high] = std::minmax_element(parts->heights.begin(), parts->heights.end());
  parts->lower = {parts->x(0), *low, parts->z(0)};
  parts->upper = {parts->x(def.columns - 1), *high, parts->z(def.rows - 1)};
  buildLevels(*parts);
  Hash64 hash;
  hash.value(def.columns);
  hash.value(def.rows);
  for (const float x : {parts->spacingX, parts->spacingZ, parts->thickness}) hash.value(x);
  hash.values(parts->heights);
  hash.values(parts->materials);
  parts->hash = hash.digest();
  return std::make_shared<const HeightFieldData>(std::move(parts));
}

}  // namespace avbd
