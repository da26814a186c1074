// A world ready to run with the names and settings that came with it: what a reader or a scene function returns.
#pragma once

#include <avbd/avbd.h>

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "io/color.h"
#include "io/probe.h"

namespace avbd {

struct NamedBody {
  BodyId id;
  std::string name;  ///< the file's name; "body_3" where the file gives none
  /// Of its shapes, in the order of World::shapes(id); empty: none is given.
  std::vector<std::optional<Color>> colors{};
};

struct NamedSoft {
  SoftId id;
  std::string name;
};

/// A coordinate of a joint by the file's name: the file's value is sign * ours + offset.
struct NamedJoint {
  std::string name;
  JointId id;
  JointAxis axis = JointAxis::Twist;
  double sign = 1, offset = 0;
};

/// What a control value moves: one coordinate of a joint, or a coupling (axis is then unused). The force along the
/// file's coordinate q is gear * (gain control + bias[0] + bias[1] gear q + bias[2] gear dq/dt), the bracket within
/// `force`.
struct Actuator {
  std::string name;
  JointId joint;
  JointAxis axis = JointAxis::Twist;
  double sign = 1, offset = 0;  ///< as in NamedJoint
  double gear = 1, gain = 1;
  double bias[3] = {0, 0, 0};
  std::optional<std::array<double, 2>> controlRange{};  ///< control is clamped to it
  double maxForce = std::numeric_limits<double>::infinity();
  double control = 0;  ///< in use
};

struct Model {
  std::string name;
  World world;
  double dt = 1.0 / 60;                ///< [s] the file's or scene's own step
  double duration = 10;                ///< [s] to run where nobody says otherwise
  Vec3 up{0, 1, 0};                    ///< unit; z for MJCF
  std::vector<NamedBody> bodies;       ///< all bodies, static ones too, in the order of the file
  std::vector<NamedSoft> softs{};      ///< their particles are among `bodies`, too
  std::vector<NamedJoint> joints{};    ///< coordinates that the file names, in its order
  std::vector<Actuator> actuators{};   ///< in the order of the file
  std::vector<Probe> probes{};         ///< what the file's sensors measure, in its order (probes.h reads them)
  ProbeTree probeTree{};               ///< what they know of the file's bodies; empty without probes
  std::vector<std::string> keyframes;  ///< names of the file's keyframes; "key_1" where it gives none
  /// What happens by itself before each step, by the number of steps made so far; may be empty.
  std::function<void(Model&, int64_t)> before{};
  std::vector<std::string> notes;  ///< what the reader did not understand or changed, one line each
};

/// Gives an actuator its control value: the drive of what it moves changes from the next step on. Several actuators of
/// one coordinate add up. Throws FileError for a value that is not finite.
void setControl(Model& model, size_t actuator, double control);

}  // namespace avbd
