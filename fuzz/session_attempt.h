// Calls that may be refused.
#pragma once

#include "fuzz/session.h"

namespace avbd::fuzz {

/// A refused call leaves every bit of the state as it was, and all that can be read.
template <class Call>
void Session::attempt(Call&& call) {
  const uint64_t before = world_.hash(), told = this->told();
  try {
    call();
  } catch (const Error& error) {
    require(world_.hash() == before, "a refused call changed the world");
    require(this->told() == told, "a refused call changed what the world tells");
    require(!error.definition().empty() && !error.field().empty(), "an error without a name");
    require(!error.range().empty(), "an error that does not say what is allowed");
  }
}

}  // namespace avbd::fuzz
