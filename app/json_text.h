// Records as JSON objects on one line, without a line end. Numbers that are not finite become null.
#pragma once

#include <string>

#include "app/figures.h"
#include "app/info_figures.h"
#include "app/soft_files.h"
#include "bench/bench.h"

namespace avbd::cli {

/// One figure of a line of acceptance, or a line that is skipped.
struct VerifyRecord {
  std::string list, line;
  scenes::Figure figure;
  std::string status;  ///< "pass", "fail" or "skipped"
  std::string reason;  ///< of "skipped"
};

std::string jsonText(const RunFigures& figures);
std::string jsonText(const bench::BenchRecord& record);
std::string jsonText(const VerifyRecord& record);
std::string jsonText(const ModelInfo& info);
std::string jsonText(const MeshInfo& info);
std::string jsonText(const SoftMeshInfo& info);
/// Each label with its text.
std::string jsonText(const ReportLines& lines);

}  // namespace avbd::cli
