// Geometry as lines and triangles, for debugDraw.
#pragma once

#include <avbd/debug_draw.h>

namespace avbd {

/// A frame to draw in: rotation, and position relative to the drawing's origin.
struct DebugFrame {
  Quat rotation;
  Vec3 position;
  Vec3 operator*(Vec3 p) const { return position + rotate(rotation, p); }
};

struct DebugPen {
  DebugSink& sink;
  const DebugDrawOptions& options;
  DebugColor color;
  DebugFrame frame;

  void line(Vec3 a, Vec3 b) const { sink.line(frame * a, frame * b, color); }
  void triangle(Vec3 a, Vec3 b, Vec3 c) const { sink.triangle(frame * a, frame * b, frame * c, color); }
};

void drawWire(const DebugPen& pen, const Geometry& geometry);
void drawSolid(const DebugPen& pen, const Geometry& geometry);
/// Largest d . p over the shape's points p in its own frame; false for a half-space.
bool farthest(const Geometry& geometry, Vec3 d, float& distance);

}  // namespace avbd
