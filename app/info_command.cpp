// `avbd info`: what a file holds, and what of it was not understood.
#include <filesystem>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/failure.h"
#include "app/info_figures.h"
#include "app/json_text.h"
#include "app/load.h"
#include "app/soft_files.h"
#include "io/record/reader.h"
#include "io/soft_mesh_file.h"

namespace avbd::cli {
namespace {

std::string kindOf(const std::string& file) {
  std::string kind = std::filesystem::path(file).extension().string();
  for (char& c : kind) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
  return kind;
}

template <class Info>
void print(const Info& info, bool json, std::ostream& out) {
  if (json) {
    out << jsonText(info) << "\n";
  } else {
    out << reportText(reportLines(info));
  }
}

MeshInfo meshInfo(const std::string& file) {
  const MeshFile mesh = readMeshFile(file);
  try {
    return infoOf(mesh, file);
  } catch (const Error& error) {
    throw FileError(file + ": " + error.what(), file);
  }
}

}  // namespace

int infoCommand(const InfoArguments& a, std::ostream& out) {
  const std::string kind = kindOf(a.file);
  if (a.soft || isSoftMeshFile(a.file)) {
    if (a.keyframe) throw BadInput("--keyframe " + *a.keyframe + ": " + a.file + " has none");
    print(infoOf(readSoft(a.file, a.soft), a.file), a.json, out);
    return kExitDone;
  }
  const bool isMesh = kind == ".obj" || kind == ".stl" || kind == ".msh",
             isRecording = kind == ".avbd" || avbd::isRecording(a.file);
  if ((isMesh || isRecording) && a.keyframe) throw BadInput("--keyframe " + *a.keyframe + ": " + a.file + " has none");
  if (isMesh) {
    print(meshInfo(a.file), a.json, out);
  } else if (isRecording) {
    const ReportLines lines = describeRecording(a.file);
    out << (a.json ? jsonText(lines) + "\n" : reportText(lines));
  } else {
    RunArguments load;
    load.scene = a.file;
    load.keyframe = a.keyframe;
    load.urdf = a.urdf;
    print(infoOf(loadModel(load)), a.json, out);
  }
  return kExitDone;
}

}  // namespace avbd::cli
