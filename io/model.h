// A world ready to run with the names and settings that came with it: what a reader or a scene function returns.
#pragma once

#include <avbd/avbd.h>

#include <optional>
#include <string>
#include <vector>

#include "io/color.h"

namespace avbd {

struct NamedBody {
  BodyId id;
  std::string name;  ///< the file's name; "body_3" where the file gives none
  /// Of its shapes, in the order of World::shapes(id); empty: none is given.
  std::vector<std::optional<Color>> colors{};
};

struct Model {
  std::string name;
  World world;
  double dt = 1.0 / 60;                ///< [s] the file's or scene's own step
  double duration = 10;                ///< [s] to run where nobody says otherwise
  Vec3 up{0, 1, 0};                    ///< unit; z for MJCF
  std::vector<NamedBody> bodies;       ///< all bodies, static ones too, in the order of the file
  std::vector<std::string> keyframes;  ///< names of the file's keyframes; "key_1" where it gives none
  std::vector<std::string> notes;      ///< what the reader did not understand or changed, one line each
};

}  // namespace avbd
