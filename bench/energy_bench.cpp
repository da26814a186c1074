// Energy of mechanisms over ten seconds, ours beside MuJoCo's of the same file in the same run.
//
// energy_bench [CSV]: a table of the lowest, highest and last energy, as a part of what the mechanism can move between
// its highest and lowest place; with CSV also a file of time series.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>

#include "io/mjcf.h"

namespace {

using namespace avbd;

constexpr double kSeconds = 10;

struct Mechanism {
  const char* name;
  double scale;  ///< [J]
  const char* body;
};

// Contacts are off: geoms have no contype.
const Mechanism kMechanisms[] = {
    {"pendulum", 9.81,
     R"(<worldbody><body euler="0 30 0"><joint type="hinge" axis="0 1 0"/>
        <geom type="capsule" size=".05" fromto="0 0 0 1 0 0" mass="1"/></body></worldbody>)"},
    {"double pendulum", 4 * 9.81,
     R"(<worldbody><body><joint type="hinge" axis="0 1 0"/><geom type="capsule" size=".05" fromto="0 0 0 1 0 0" mass="1"/>
        <body pos="1 0 0"><joint type="hinge" axis="0 1 0"/>
        <geom type="capsule" size=".05" fromto="0 0 0 1 0 0" mass="1"/></body></body></worldbody>)"},
    {"slider-crank", 9.81,
     R"(<worldbody><body><joint type="hinge" axis="0 1 0"/><geom type="cylinder" size=".5 .05" euler="90 0 0" mass="2"/>
        <geom type="box" size=".02 .02 .02" pos=".3 0 0" mass=".2"/>
        <body pos=".3 0 0"><joint type="hinge" axis="0 1 0"/><geom type="capsule" size=".02" fromto="0 0 0 1 0 0" mass=".5"/>
        </body></body>
        <body name="piston" pos="1.3 0 0"><joint type="slide" axis="1 0 0"/><geom type="box" size=".1 .1 .1" mass="1"/></body>
        </worldbody><equality><connect body1="piston" body2="rod" anchor="0 0 0"/></equality>)"},
    {"spinning top", 9.81,
     R"(<worldbody><body euler="20 0 0"><joint type="ball"/><geom type="cylinder" size=".3 .03" pos="0 0 .5" mass="1"/></body>
        </worldbody>)"},
};

std::string fileOf(const Mechanism& m, double dt) {
  std::string body = m.body;
  // The rod of the crank needs a name, and the wheel and the top a speed, which a keyframe gives.
  if (std::string(m.name) == "slider-crank")
    body.replace(body.find("<body pos=\".3 0 0\">"), 19, "<body name=\"rod\" pos=\".3 0 0\">");
  std::string key;
  if (std::string(m.name) == "slider-crank") key = R"(<keyframe><key qvel="6 -7.8 0"/></keyframe>)";
  if (std::string(m.name) == "spinning top")
    key = R"(<keyframe><key qpos=".984807753 .173648178 0 0" qvel="0 0 60"/></keyframe>)";
  char head[300];
  std::snprintf(
      head, sizeof head,
      R"(<mujoco><option timestep="%.17g"><flag energy="enable"/></option><default><geom contype="0" conaffinity="0"/>)"
      R"(<joint damping="0"/></default>)",
      dt);
  return head + body + key + "</mujoco>";
}

struct Range {
  double low = 0, high = 0, last = 0;
  void add(double x) { low = std::min(low, x), high = std::max(high, x), last = x; }
};

using Series = std::function<void(double time, double change)>;

double energyOf(const Model& model) {
  double sum = model.world.kineticEnergy();
  for (const NamedBody& body : model.bodies)
    sum += double(model.world.mass(body.id)) * 9.81 * model.world.worldCenterOfMass(body.id).z;
  return sum;
}

Range ours(const Mechanism& m, double dt, int substeps, const Series& out) {
  WorldDef def;
  def.substeps = substeps;
  def.sleep = false;
  Model model = readMjcfText(fileOf(m, dt), m.name, {.world = def});
  const double start = energyOf(model);
  Range range;
  for (int i = 1; i <= static_cast<int>(std::lround(kSeconds / dt)); ++i) {
    model.world.step(static_cast<float>(dt));
    const double change = (energyOf(model) - start) / m.scale;
    range.add(change), out(i * dt, change);
  }
  return range;
}

Range mujoco(const Mechanism& m, double dt, int integrator, const Series& out) {
  const std::string path = (std::filesystem::temp_directory_path() / "avbd_energy_bench.xml").string();
  std::ofstream(path) << fileOf(m, dt);
  char error[500] = "";
  const std::unique_ptr<mjModel, void (*)(mjModel*)> model(mj_loadXML(path.c_str(), nullptr, error, sizeof error),
                                                           mj_deleteModel);
  if (!model) {
    std::fprintf(stderr, "MuJoCo: %s\n", error);
    std::exit(1);
  }
  model->opt.integrator = integrator;
  const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(model.get()), mj_deleteData);
  if (model->nkey > 0) mj_resetDataKeyframe(model.get(), data.get(), 0);
  mj_forward(model.get(), data.get());
  const double start = data->energy[0] + data->energy[1];
  Range range;
  for (int i = 1; i <= static_cast<int>(std::lround(kSeconds / dt)); ++i) {
    mj_step(model.get(), data.get());
    mj_forward(model.get(), data.get());
    const double change = (data->energy[0] + data->energy[1] - start) / m.scale;
    range.add(change), out(i * dt, change);
  }
  return range;
}

}  // namespace

int main(int count, char** values) {
  std::ofstream csv;
  if (count > 1) csv.open(values[1]), csv << "mechanism,engine,dt,time,change\n";
  std::printf("%-16s %-8s %-22s %10s %10s %10s\n", "mechanism", "dt", "engine", "lowest %", "highest %", "last %");
  for (const Mechanism& m : kMechanisms)
    for (const double dt : {1.0 / 60, 1.0 / 240}) {
      const auto series = [&](const char* engine) {
        return [&csv, &m, dt, engine](double time, double change) {
          if (csv.is_open())
            csv << m.name << ',' << engine << ",1/" << std::lround(1 / dt) << ',' << time << ',' << change << '\n';
        };
      };
      const auto print = [&](const char* engine, const Range& r) {
        std::printf("%-16s 1/%-6ld %-22s %10.3f %10.3f %10.3f\n", m.name, std::lround(1 / dt), engine, 100 * r.low,
                    100 * r.high, 100 * r.last);
      };
      print("AVBD", ours(m, dt, 1, series("AVBD")));
      print("AVBD, 4 substeps", ours(m, dt, 4, series("AVBD 4")));
      print("MuJoCo, Euler", mujoco(m, dt, mjINT_EULER, series("MuJoCo Euler")));
      print("MuJoCo, RK4", mujoco(m, dt, mjINT_RK4, series("MuJoCo RK4")));
    }
}
