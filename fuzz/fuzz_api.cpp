// Sequences of calls to a world, with a check of the whole after each.
#include "fuzz/session.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace avbd::fuzz;
  const auto run = [&](int simdWidth) {
    Bytes in(data, size);
    return Session(in, simdWidth).run();
  };
  const uint64_t states = run(1);
  // Twice the time, so not always: the same calls give the same bits whatever the width.
  if (size % 4 == 0) require(run(4) == states, "another width, another world");
  return 0;
}
