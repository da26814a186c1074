// The table of kinds of probes.
#include "io/probe.h"

#include <iterator>

namespace avbd {

namespace {

constexpr ProbeBound kReal = ProbeBound::Real, kPositive = ProbeBound::Positive, kUnit = ProbeBound::Unit;

// By ProbeKind.
constexpr ProbeKindFacts kFacts[] = {
    {"jointpos", 1, ""},
    {"jointvel", 1, ""},
    {"jointactuatorfrc", 1, ""},
    {"tendonpos", 1, ""},
    {"tendonvel", 1, ""},
    {"tendonactuatorfrc", 1, ""},
    {"actuatorpos", 1, ""},
    {"actuatorvel", 1, ""},
    {"actuatorfrc", 1, ""},
    {"jointlimitpos", 1, ""},
    {"jointlimitvel", 1, ""},
    {"tendonlimitpos", 1, ""},
    {"tendonlimitvel", 1, ""},
    {"ballquat", 4, "", kUnit},
    {"ballangvel", 3, "rad/s"},
    {"framepos", 3, "m"},
    {"framequat", 4, "", kUnit},
    {"framexaxis", 3, "", kUnit},
    {"frameyaxis", 3, "", kUnit},
    {"framezaxis", 3, "", kUnit},
    {"framelinvel", 3, "m/s"},
    {"frameangvel", 3, "rad/s"},
    {"framelinacc", 3, "m/s^2", kReal, true},
    {"frameangacc", 3, "rad/s^2", kReal, true},
    {"accelerometer", 3, "m/s^2", kReal, true},
    {"velocimeter", 3, "m/s"},
    {"gyro", 3, "rad/s"},
    {"force", 3, "N", kReal, true},
    {"torque", 3, "N m", kReal, true},
    {"touch", 1, "N", kPositive, true},
    {"rangefinder", 1, "m", kPositive},
    {"magnetometer", 3, ""},
    {"subtreecom", 3, "m"},
    {"subtreelinvel", 3, "m/s"},
    {"subtreeangmom", 3, "kg m^2/s"},
    {"clock", 1, "s"},
};
static_assert(std::size(kFacts) == static_cast<size_t>(ProbeKind::Clock) + 1);

}  // namespace

const ProbeKindFacts& factsOf(ProbeKind kind) { return kFacts[static_cast<size_t>(kind)]; }

}  // namespace avbd
