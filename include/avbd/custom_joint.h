// Joints of the user's own: rows over up to four bodies, in the same solve as everything else.
#pragma once

#include <avbd/joint.h>

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace avbd {

inline constexpr int kCustomRows = 6;

/// A body as a custom joint's rows see it.
struct CustomBody {
  Pose pose;     ///< of the body's frame [m]; of a null body the identity
  Vec3d center;  ///< centre of mass [m]
};

/// One row: a force along J that drives C to zero. What acts on body i is force -linear[i] times the multiplier at its
/// centre of mass and torque -angular[i] times it; where the bodies feel nothing but each other, both must cancel.
struct CustomRow {
  double C = 0;                                           ///< in the row's own unit
  std::array<Vec3, 4> linear{};                           ///< dC / d(centre of mass of body i)
  std::array<Vec3, 4> angular{};                          ///< dC / d(turn of body i [rad]), world axes
  float stiffness = 0;                                    ///< >= 0: force = stiffness C; 0: hard
  float lower = -std::numeric_limits<float>::infinity();  ///< bounds of the multiplier: lower <= 0 <= upper
  float upper = std::numeric_limits<float>::infinity();

  /// Adds to J that C changes with the motion of a world point of body i along `direction`.
  void addPoint(int body, const CustomBody& at, Vec3d point, Vec3 direction);
};

/// The user's family: what its rows are. Objects are shared by joints and must not change; they must give the same for
/// the same arguments, must not throw and must not touch the world.
class CustomFamily {
 public:
  virtual ~CustomFamily() = default;
  virtual std::string name() const = 0;
  virtual int rowCount() const = 0;  ///< 1 .. kCustomRows
  /// Fills `rows` (rowCount of them, each as a fresh CustomRow) for the bodies where they are now; `start`: where they
  /// were at the start of the step of dt seconds. `constants` are the joint's own, `memory` what it keeps.
  virtual void evaluate(std::span<const CustomBody> now, std::span<const CustomBody> start, float dt,
                        std::span<const float> constants, std::span<const float> memory,
                        std::span<CustomRow> rows) const = 0;
  /// After each substep: what the joint shall remember. Part of the world's state.
  virtual void remember(std::span<const CustomBody> now, std::span<const float> constants,
                        std::span<float> memory) const;
};

/// A joint of a user's family.
struct CustomJoint {
  std::shared_ptr<const CustomFamily> family{};
  std::array<BodyId, 4> bodies{};  ///< the first ones that are used; a null id among them is the world
  int bodyCount = 2;               ///< 1 .. 4
  std::vector<float> constants{};  ///< finite, at most 64
  std::vector<float> memory{};     ///< what it remembers at first: finite, at most 64
  bool collideConnected = false;   ///< of bodies[0] and bodies[1]
  uint64_t userData = 0;
};

/// Law test: the largest difference between a family's J and the finite differences of its C over all motions of the
/// bodies of a size `step` [m, rad].
double jacobianError(const CustomFamily& family, std::span<const CustomBody> bodies, std::span<const float> constants,
                     std::span<const float> memory, double step = 1e-4);
/// Law test: the largest force or torque about the origin that the rows of multiplier 1 leave in sum.
double reactionError(const CustomFamily& family, std::span<const CustomBody> bodies, std::span<const float> constants,
                     std::span<const float> memory);

}  // namespace avbd
