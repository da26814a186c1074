// What the library throws.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace avbd {

/// Bad input. Thrown before anything has changed. what() reads "BodyDef.mass = nan: must be finite and > 0".
class Error : public std::runtime_error {
 public:
  Error(std::string definition, std::string field, std::string value, std::string range);
  const std::string& definition() const { return definition_; }  ///< type or call, e.g. "BodyDef"
  const std::string& field() const { return field_; }            ///< e.g. "mass"
  const std::string& value() const { return value_; }            ///< the value refused, as text
  const std::string& range() const { return range_; }            ///< what is allowed, e.g. "must be finite and > 0"

 private:
  std::string definition_, field_, value_, range_;
};

/// A body's state became NaN or infinite during a step. The step stopped at `stage` and the world keeps the poses and
/// velocities it had before that step, and the forces given for it (World::clearForces).
class NonFiniteError : public std::runtime_error {
 public:
  NonFiniteError(std::string stage, uint32_t bodyIndex, uint32_t bodyGeneration);
  const std::string& stage() const { return stage_; }  ///< name of the stage of the step, e.g. "solve_blocks"
  uint32_t bodyIndex() const { return bodyIndex_; }    ///< BodyId::index of the first body found
  uint32_t bodyGeneration() const { return bodyGeneration_; }

 private:
  std::string stage_;
  uint32_t bodyIndex_, bodyGeneration_;
};

}  // namespace avbd
