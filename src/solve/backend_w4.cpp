// Kernels with 4 lane(s).
#define AVBD_LANES 4
#define AVBD_LANES_NAMESPACE w4
#include "solve/kernels.h"
