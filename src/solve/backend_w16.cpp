// Kernels with 16 lane(s).
#define AVBD_LANES 16
#define AVBD_LANES_NAMESPACE w16
#include "solve/kernels.h"
