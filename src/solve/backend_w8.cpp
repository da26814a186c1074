// Kernels with 8 lane(s).
#define AVBD_LANES 8
#define AVBD_LANES_NAMESPACE w8
#include "solve/kernels.h"
