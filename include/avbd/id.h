// Ids of things in a world: an index and a generation, so that an id of something destroyed is recognised.
#pragma once

#include <compare>
#include <cstdint>

namespace avbd {

/// Names one thing of one World. Default-constructed (all zero) it is null. Ids are never reused: after destroy()
/// the slot's generation has changed, and every use of the old id throws Error.
template <class Tag>
struct Id {
  uint32_t index = 0;       ///< slot + 1; 0 is null
  uint32_t generation = 0;  ///< how often the slot was taken
  explicit operator bool() const { return index != 0; }
  friend auto operator<=>(const Id&, const Id&) = default;
};

using BodyId = Id<struct BodyTag>;
using ShapeId = Id<struct ShapeTag>;
using JointId = Id<struct JointTag>;
using SoftId = Id<struct SoftTag>;

}  // namespace avbd
