// The table of MJCF's attributes, continued: flexes and composites.
#include "io/mjcf_schema.h"

namespace avbd::mjcf {

namespace {

constexpr Use R = Use::Read, S = Use::Silent, N = Use::Noted, Z = Use::NotedUnless0;
constexpr int kMany = 1 << 28;

// Children of flexes and composites have names that others have too: flexedge is <edge> inside <flex> or <flexcomp>.
constexpr AttributeRule kSoftRules[] = {
    {"flex", "name", 0, 0, R},
    {"flex", "group", 1, 1, R},
    {"flex", "dim", 1, 1, R},
    {"flex", "radius", 1, 1, R},
    {"flex", "material", 0, 0, R},
    {"flex", "rgba", 4, 4, R},
    {"flex", "flatskin", 0, 0, S},
    {"flex", "body", 0, 0, R},
    {"flex", "vertex", 0, kMany, R},
    {"flex", "element", 0, kMany, R},
    {"flex", "texcoord", 0, kMany, S},
    {"flex", "elemtexcoord", 0, kMany, S},
    {"flex", "node", 0, 0, R},
    {"flex", "nodecoord", 0, kMany, S},
    {"flex", "cellcount", 0, kMany, S},
    {"flex", "dof", 0, 0, S},

    {"flexcomp", "name", 0, 0, R},
    {"flexcomp", "type", 0, 0, R},
    {"flexcomp", "group", 1, 1, R},
    {"flexcomp", "dim", 1, 1, R},
    {"flexcomp", "dof", 0, 0, R},
    {"flexcomp", "count", 1, 3, R},
    {"flexcomp", "cellcount", 1, 3, S},
    {"flexcomp", "spacing", 1, 3, R},
    {"flexcomp", "point", 0, kMany, R},
    {"flexcomp", "element", 0, kMany, R},
    {"flexcomp", "texcoord", 0, kMany, S},
    {"flexcomp", "mass", 1, 1, R},
    {"flexcomp", "inertiabox", 1, 1, R},
    {"flexcomp", "file", 0, 0, R},
    {"flexcomp", "rigid", 0, 0, R},
    {"flexcomp", "scale", 3, 3, R},
    {"flexcomp", "radius", 1, 1, R},
    {"flexcomp", "material", 0, 0, R},
    {"flexcomp", "rgba", 4, 4, R},
    {"flexcomp", "flatskin", 0, 0, S},
    {"flexcomp", "origin", 3, 3, R},

    {"flexedge", "equality", 0, 0, R},
    {"flexedge", "stiffness", 1, 1, R},
    {"flexedge", "damping", 1, 1, R},
    {"flexedge", "solref", 1, 2, N},
    {"flexedge", "solimp", 1, 5, N},

    {"flexelasticity", "young", 1, 1, R},
    {"flexelasticity", "poisson", 1, 1, R},
    {"flexelasticity", "damping", 1, 1, R},
    {"flexelasticity", "thickness", 1, 1, R},
    {"flexelasticity", "elastic2d", 0, 0, R},

    {"flexcontact", "contype", 1, 1, R},
    {"flexcontact", "conaffinity", 1, 1, R},
    {"flexcontact", "condim", 1, 1, R},
    {"flexcontact", "priority", 1, 1, R},
    {"flexcontact", "friction", 1, 3, R},
    {"flexcontact", "selfcollide", 0, 0, R},
    {"flexcontact", "internal", 0, 0, S},
    {"flexcontact", "activelayers", 1, 1, S},
    {"flexcontact", "vertcollide", 0, 0, S},
    {"flexcontact", "passive", 0, 0, N},
    {"flexcontact", "solmix", 1, 1, S},
    {"flexcontact", "solref", 1, 2, N},
    {"flexcontact", "solimp", 1, 5, N},
    {"flexcontact", "margin", 1, 1, Z},
    {"flexcontact", "gap", 1, 1, Z},

    {"flexpin", "id", 0, kMany, R},
    {"flexpin", "range", 0, kMany, R},
    {"flexpin", "grid", 0, kMany, R},
    {"flexpin", "gridrange", 0, kMany, R},

    {"flexplugin", "plugin", 0, 0, R},
    {"flexplugin", "instance", 0, 0, R},
    {"flexconfig", "key", 0, 0, R},
    {"flexconfig", "value", 0, 0, R},

    {"flexequality", "name", 0, 0, R},
    {"flexequality", "class", 0, 0, R},
    {"flexequality", "active", 0, 0, R},
    {"flexequality", "flex", 0, 0, R},
    {"flexequality", "cell", 3, 3, N},
    {"flexequality", "solref", 1, 2, N},
    {"flexequality", "solimp", 1, 5, N},

    {"composite", "prefix", 0, 0, R},
    {"composite", "type", 0, 0, R},
    {"composite", "count", 1, 3, R},
    {"composite", "spacing", 1, 1, R},
    {"composite", "offset", 3, 3, R},
    {"composite", "quat", 4, 4, R},
    {"composite", "vertex", 0, kMany, R},
    {"composite", "initial", 0, 0, R},
    {"composite", "curve", 0, 0, R},
    {"composite", "size", 1, 3, R},
    {"composite", "flatinertia", 1, 1, N},
    {"composite", "solrefsmooth", 1, 2, N},
    {"composite", "solimpsmooth", 1, 5, N},

    {"compositejoint", "kind", 0, 0, R},
    {"compositejoint", "solreffix", 1, 2, N},
    {"compositejoint", "solimpfix", 1, 5, N},
    {"compositetendon", "kind", 0, 0, S},
    {"compositetendon", "solreffix", 1, 2, N},
    {"compositetendon", "solimpfix", 1, 5, N},
    {"compositetendon", "stiffness", 1, 1, R},
    {"compositetendon", "damping", 1, 1, Z},
    {"compositepin", "coord", 1, 2, R},
};

}  // namespace

std::span<const AttributeRule> softRules() { return kSoftRules; }

}  // namespace avbd::mjcf
