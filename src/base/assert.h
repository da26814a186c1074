// AVBD_ASSERT: states what must hold unless this library has a bug. Bad input is never asserted; it throws Error.
#pragma once

// Headers of wide back-ends include this file, so it holds a declaration and a macro but no inline function.
namespace avbd {
[[noreturn]] void assertFailed(const char* expression, const char* file, int line);
}

#if !defined(NDEBUG) || defined(AVBD_ASSERTS)
#define AVBD_ASSERTS_ON 1
#define AVBD_ASSERT(expression) \
  ((expression) ? static_cast<void>(0) : ::avbd::assertFailed(#expression, __FILE__, __LINE__))
#else
#define AVBD_ASSERTS_ON 0
// Not evaluated, yet still compiled: what it names stays used and valid.
#define AVBD_ASSERT(expression) static_cast<void>(sizeof((expression) ? 1 : 0))
#endif
