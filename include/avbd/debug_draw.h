// What a world looks like, as lines, triangles, points and text: for programs with a renderer of their own.
#pragma once

#include <avbd/height_field.h>
#include <avbd/hull.h>
#include <avbd/mesh.h>
#include <avbd/world.h>

#include <cstdint>
#include <string_view>
#include <vector>

namespace avbd {

/// 0xAARRGGBB.
using DebugColor = uint32_t;

/// Takes what is drawn. Positions are relative to DebugDrawOptions::origin. Calls come in a fixed order.
class DebugSink {
 public:
  virtual ~DebugSink() = default;
  virtual void line(Vec3 from, Vec3 to, DebugColor color) = 0;
  /// Anticlockwise seen from outside.
  virtual void triangle(Vec3 a, Vec3 b, Vec3 c, DebugColor color) = 0;
  virtual void point(Vec3 position, float size, DebugColor color) = 0;  ///< size [pixels]
  virtual void text(Vec3 position, std::string_view text, DebugColor color) = 0;
};

/// A sink that keeps everything as plain arrays, ready for vertex buffers.
class DebugLists : public DebugSink {
 public:
  struct Vertex {
    Vec3 position;
    DebugColor color = 0;
  };
  struct Point {
    Vec3 position;
    float size = 0;
    DebugColor color = 0;
  };
  struct Text {
    Vec3 position;
    std::string_view text;  ///< of `characters`; valid until the next clear() or draw
    DebugColor color = 0;
  };
  std::vector<Vertex> lines;      ///< two each
  std::vector<Vertex> triangles;  ///< three each
  std::vector<Point> points;

  void clear();  ///< keeps the memory
  size_t textCount() const { return texts_.size(); }
  Text text(size_t i) const;

  void line(Vec3 from, Vec3 to, DebugColor color) override;
  void triangle(Vec3 a, Vec3 b, Vec3 c, DebugColor color) override;
  void point(Vec3 position, float size, DebugColor color) override;
  void text(Vec3 position, std::string_view text, DebugColor color) override;

 private:
  struct Place {
    Vec3 position;
    DebugColor color;
    uint32_t first, count;
  };
  std::vector<Place> texts_;
  std::vector<char> characters_;
};

struct DebugDrawOptions {
  bool wire = true;               ///< edges of shapes; of round ones a few circles
  bool solid = false;             ///< triangles of shapes
  bool triggers = true;           ///< shapes with isTrigger
  bool bounds = false;            ///< box around each shape, along the world's axes
  bool contacts = false;          ///< points, normals, and forces as lines
  bool joints = false;            ///< anchors, and lines from the bodies to them
  bool centersOfMass = false;     ///< as crosses
  bool velocities = false;        ///< linear as lines from the centre of mass
  bool islands = false;           ///< colours by connected groups of dynamic bodies instead of by kind
  bool bodyIds = false;           ///< index of each body as text
  float lengthPerNewton = 1e-3f;  ///< [m/N] of a contact's force
  float lengthPerSpeed = 0.1f;    ///< [s]: metres per metre a second
  float size = 0.1f;              ///< [m] of crosses and normals
  int segments = 16;              ///< of a circle, 4 .. 256
  float planeHalf = 10;           ///< [m] of the square that stands for a half-space
  Vec3d origin{};                 ///< world position that everything is drawn relative to, e.g. the camera's
};

/// Draws the world as it is now. Throws Error for options out of range.
void debugDraw(const World& world, DebugSink& sink, const DebugDrawOptions& options = {});

/// Draws one geometry: wire and/or solid as the options say. Throws Error before anything is drawn.
void debugDraw(const Geometry& geometry, const Pose& pose, DebugColor color, DebugSink& sink,
               const DebugDrawOptions& options = {});

}  // namespace avbd
