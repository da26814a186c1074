// The same question put to qhull, for tests and benchmarks that link it.
#pragma once

#include <avbd/types.h>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include <set>
#include <span>
#include <vector>

namespace avbd {

struct QhullAnswer {
  std::set<int> vertices;  ///< indices of points
  double volume = 0;
};

/// Empty where qhull gives up.
inline QhullAnswer askQhull(std::span<const Vec3> points) {
  std::vector<double> flat;
  for (const Vec3& p : points) flat.insert(flat.end(), {p.x, p.y, p.z});
  qhT memory;
  qhT* qh = &memory;
  qh_zero(qh, stderr);
  char options[] = "qhull Pp";
  FILE* quiet = fopen("/dev/null", "w");
  QhullAnswer answer;
  if (qh_new_qhull(qh, 3, static_cast<int>(points.size()), flat.data(), False, options, quiet, quiet) == 0) {
    qh_getarea(qh, qh->facet_list);
    answer.volume = qh->totvol;
    vertexT* vertex;
    FORALLvertices answer.vertices.insert(qh_pointid(qh, vertex->point));
  }
  qh_freeqhull(qh, qh_ALL);
  if (quiet) fclose(quiet);
  return answer;
}

}  // namespace avbd
