// Acceptance: everything broken is refused by name and changes nothing.
#include "io/mesh_file.h"
#include "io/mjcf.h"
#include "io/urdf.h"
#include "scenes/bad_input.h"
#include "scenes/catalogue.h"

namespace avbd::scenes {
namespace {

struct Tally {
  int tried = 0, refused = 0;
  std::string first;  ///< what was not refused as it ought to be

  void count(bool good, const std::string& what) {
    ++tried;
    refused += good;
    if (!good && first.empty()) first = what;
  }
};

bool isRefused(const BadCall& bad) {
  Victim victim = makeVictim();
  const uint64_t before = victim.world.hash();
  try {
    bad.call(victim);
  } catch (const Error& e) {
    return e.definition() == bad.definition && e.field() == bad.field && !e.value().empty() && !e.range().empty() &&
           victim.world.hash() == before;
  }
  return false;
}

void readText(const BadFile& file) {
  if (file.kind == "mjcf") {
    readMjcfText(file.text, "bad.xml");
  } else if (file.kind == "urdf") {
    readUrdfText(file.text, "bad.urdf");
  } else {
    readMeshBytes(std::as_bytes(std::span(file.text)), file.kind, "bad." + file.kind);
  }
}

bool isRefused(const BadFile& file) {
  try {
    readText(file);
  } catch (const FileError& e) {
    const std::string message = e.what();
    return message.find("bad.") == 0 && message.find(file.names) != std::string::npos;
  }
  return false;
}

std::vector<Figure> badInput(const Settings&) {
  Tally tally;
  for (const auto& corpus : {badBodies(), badShapes(), badCalls()})
    for (const BadCall& bad : corpus) tally.count(isRefused(bad), bad.definition + "." + bad.field + " = " + bad.value);
  for (const BadFile& file : badFiles()) tally.count(isRefused(file), file.kind + " " + file.names);
  return {{"tried", "", static_cast<double>(tally.tried), 200, 1e9, "inputs"},
          {"not_refused", tally.first.empty() ? "" : "first=" + tally.first,
           static_cast<double>(tally.tried - tally.refused), 0, 0, "inputs"}};
}

}  // namespace

Victim makeVictim() {
  Victim v;
  BodyDef floor;
  floor.type = BodyType::Static;
  floor.shape = HalfSpace{};
  v.floor = v.world.create(floor);
  BodyDef box;
  box.position = {0, 0.5, 0};
  box.shape = Box{0.5f, 0.5f, 0.5f};
  v.box = v.world.create(box);
  box.position = {3, 0.5, 0};
  v.deadBody = v.world.create(box);
  v.boxShape = v.world.shapes(v.box)[0];
  v.deadShape = v.world.shapes(v.deadBody)[0];
  v.joint = v.world.create(BallJoint{.bodyB = v.box, .frameA = {{0, 1, 0}}, .frameB = {{0, 0.5, 0}}});
  v.deadJoint = v.world.create(BallJoint{.bodyA = v.deadBody, .bodyB = v.box});
  v.world.destroy(v.deadBody);
  v.world.step(1.0f / 60);
  return v;
}

std::vector<Line> badInputLines() { return {{"D", "bad_input", badInput, ""}}; }

}  // namespace avbd::scenes
