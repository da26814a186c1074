// Mathematics over a real R: real.h (reals, trigonometry), math3.h (vectors, rotations, 3x3), math6.h (6x6 blocks).
#pragma once

#include <avbd/rows/math6.h>
