// Looking into models that tests of MJCF read.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "io/model.h"

namespace avbd {

inline bool hasNote(const Model& model, const std::string& part) {
  return std::any_of(model.notes.begin(), model.notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

inline BodyId bodyOf(const Model& model, const std::string& name) {
  for (const NamedBody& body : model.bodies) {
    if (body.name == name) return body.id;
  }
  ADD_FAILURE() << "no body " << name;
  return {};
}

}  // namespace avbd
