// Kernels with 1 lane(s).
#define AVBD_LANES 1
#define AVBD_LANES_NAMESPACE w1
#include "solve/kernels.h"
