// MuJoCo as a peer: the same bodies, shapes and joints, its own defaults, one step a frame.
#include <mujoco/mujoco.h>

#include <cmath>
#include <cstring>
#include <memory>

#include "bench/bench.h"
#include "bench/mujoco_text.h"

namespace avbd::bench {
namespace {

using scenes::Layout;

struct Free {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
  void operator()(mjData* d) const { mj_deleteData(d); }
  void operator()(mjVFS* v) const {
    mj_deleteVFS(v);
    delete v;
  }
};

class MujocoWorld final : public scenes::Engine {
 public:
  MujocoWorld(const World& source, const Layout& layout);
  void step(double dt) override;
  void poses(std::span<Pose> out) const override;

 private:
  void read(const std::string& xml);
  void setVelocities(const World& source, const Layout& layout, const MujocoText& text);

  std::unique_ptr<mjModel, Free> model_;
  std::unique_ptr<mjData, Free> data_;
  std::vector<int> bodies_;
  bool unstable_ = false;
};

// MuJoCo would end the program.
void fail(const char* message) { throw Error("benchMujoco", "scene", message, "must be one that MuJoCo steps"); }

void ignore(const char*) {}

MujocoWorld::MujocoWorld(const World& source, const Layout& layout) {
  const MujocoText text = mujocoText(source, layout);
  mju_user_error = fail;
  mju_user_warning = ignore;  // it would print and write a file
  read(text.xml);
  for (size_t i = 0; i < layout.bodies.size(); ++i)
    bodies_.push_back(mj_name2id(model_.get(), mjOBJ_BODY, ("b" + std::to_string(i)).c_str()));
  data_.reset(mj_makeData(model_.get()));
  if (!data_) throw Error("benchMujoco", "scene", "large", "must fit the memory");
  setVelocities(source, layout, text);
}

void MujocoWorld::read(const std::string& xml) {
  const std::unique_ptr<mjVFS, Free> files(new mjVFS);
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "scene.xml", static_cast<int>(xml.size()));
  std::memcpy(files->filedata[0], xml.data(), xml.size());
  char error[1000] = "";
  model_.reset(mj_loadXML("scene.xml", files.get(), error, sizeof error));
  if (!model_) throw Error("benchMujoco", "scene", error, "must be what MuJoCo reads");
}

// Of what floats; angular ones in the body's axes.
void MujocoWorld::setVelocities(const World& source, const Layout& layout, const MujocoText& text) {
  for (size_t i = 0; i < bodies_.size(); ++i) {
    if (!text.floating[i]) continue;
    const Velocity v = source.velocity(layout.bodies[i]);
    const Vec3 w = rotate(conjugate(source.pose(layout.bodies[i]).rotation), v.angular);
    mjtNum* to = data_->qvel + model_->body_dofadr[bodies_[i]];
    const float all[] = {v.linear.x, v.linear.y, v.linear.z, w.x, w.y, w.z};
    for (int k = 0; k < 6; ++k) to[k] = all[k];
  }
}

void MujocoWorld::step(double) {
  mj_step(model_.get(), data_.get());
  if (data_->warning[mjWARN_CONTACTFULL].number > 0 || data_->warning[mjWARN_CNSTRFULL].number > 0)
    throw Error("benchMujoco", "scene", "crowded", "must have no more contacts than fit MuJoCo's dense matrices");
  // MuJoCo would start anew.
  for (const int bad : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC})
    unstable_ = unstable_ || data_->warning[bad].number > 0;
}

void MujocoWorld::poses(std::span<Pose> out) const {
  mj_kinematics(model_.get(), data_.get());  // a step leaves those of its start
  for (size_t i = 0; i < bodies_.size(); ++i) {
    const mjtNum *p = data_->xpos + 3 * bodies_[i], *q = data_->xquat + 4 * bodies_[i];
    const double x = unstable_ ? std::nan("") : p[0];
    out[i] = {{x, p[1], p[2]}, {float(q[0]), float(q[1]), float(q[2]), float(q[3])}};
  }
}

}  // namespace

BenchRecord benchMujoco(const scenes::Scene& scene) {
  return observePeer(scene, "mujoco", [](const World& world, const Layout& layout) {
    return std::make_unique<MujocoWorld>(world, layout);
  });
}

}  // namespace avbd::bench
