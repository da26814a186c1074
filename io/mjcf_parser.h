// The reader behind mjcf_parse.h: walks the elements and fills a Description.
#pragma once

#include <functional>
#include <set>

#include "io/mjcf_defaults.h"
#include "io/mjcf_parse.h"

namespace avbd::mjcf {

enum class FromGeoms { No, Yes, Auto };

struct Compiler {
  bool degrees = true;
  std::string eulerOrder = "xyz";
  FromGeoms inertiaFromGeom = FromGeoms::Auto;
  double groupFirst = 0, groupLast = 5;
  double boundMass = 0, boundInertia = 0;
  bool balanceInertia = false;
  double setTotalMass = -1;
  bool stripPath = false, fitAabb = false, exactMeshInertia = false;
  std::string meshFolder;
  bool autoLimits = true;
};

/// What the file's flags switch off.
struct SwitchedOff {
  bool equalities = false, limits = false, frictions = false, springs = false, dampers = false;
  bool controlRanges = false, actuators = false, sensors = false;
};

/// Where a mesh of the file comes from; read when a geom first uses it.
struct MeshSource {
  Attributes attributes;
  bool isRead = false;
};

/// What a <composite> says.
struct Composite {
  enum class Kind { Particle, Grid, Cable, Rope, Loop, Cloth, Box, Cylinder, Ellipsoid };
  Elem elem;
  Attributes attributes;
  std::string where, prefix;
  Kind kind = Kind::Particle;
  std::array<int, 3> count{1, 1, 1};
  size_t dim = 0;              ///< counts above 1
  double spacing = 0;          ///< [m]
  Vec3d offset{};              ///< in the parent body's frame
  Geom geom{};                 ///< of each element
  Joint joint{};               ///< what its main joints have in common
  double tendonStiffness = 0;  ///< [N/m]
  std::optional<Attributes> geomAttributes{};
};

/// What an <inertial> says.
struct Inertial {
  Elem elem;
  bool given = false;
  Mass mass;  // in the body's frame
  std::optional<Quatd> axes{};
};

/// One element whose children are being read, on the walk through the bodies.
struct OpenElem {
  std::vector<Elem> children;
  size_t next = 0;
  int body = 0;
  int cls = Defaults::kMain;  // for children that name none
  Posed frame;                // of <frame>s since the body, in the body's frame
};

class Parser {
 public:
  explicit Parser(XmlSource source) : source_(std::move(source)), defaults_(source_) {}
  Parser(const Parser&) = delete;
  Description run();

 private:
  // mjcf_parser.cpp: the sections
  void forSection(std::string_view name, const std::function<void(Elem)>& read);
  void noteChildren(Elem section, std::string_view sectionName);
  void readRoot();
  void readCompiler(Elem elem);
  void readOption(Elem elem);
  void readFlag(Elem elem);
  void readAssets(Elem elem);
  Attributes own(Elem elem, std::string_view element);

  // mjcf_parser_assets.cpp: meshes and height fields
  std::string assetName(const Attributes& a) const;
  std::filesystem::path assetPath(const Attributes& a);
  void charge(const Attributes& a, std::string_view attribute, uintmax_t bytes);
  void readMesh(Elem elem);
  void readMaterial(Elem elem);
  void readHeights(Elem elem);
  void heightsFromFile(const Attributes& a, HeightAsset& out);
  void heightsFromText(const Attributes& a, HeightAsset& out);
  int meshNamed(const Attributes& a);
  void loadMesh(const Attributes& a, MeshAsset& out);
  void inlineMesh(const Attributes& a, MeshAsset& out);
  void placeMesh(const Attributes& a, MeshAsset& out) const;
  void weighMesh(const Attributes& a, MeshAsset& out);

  // mjcf_parser_bodies.cpp: the tree
  void readBodies(Elem worldbody);
  void readBodyChild(Elem elem, std::vector<OpenElem>& open);
  void openBody(Elem elem, std::vector<OpenElem>& open);
  void openFrame(Elem elem, std::vector<OpenElem>& open);
  void readSite(Elem elem, const OpenElem& in);
  ProbeZone siteZone(const Attributes& a) const;
  void readInertial(Elem elem, const OpenElem& in);
  void finishTree();
  Quatd orientation(const Attributes& a) const;
  Posed pose(const Attributes& a) const;
  Vec3d vector(const Attributes& a, std::string_view name, Vec3d otherwise) const;
  std::string nameOnce(const Attributes& a, std::set<std::string, std::less<>>& names);

  // mjcf_parser_flex.cpp: flexes and their parts
  void readDeformables(Elem elem);
  void readFlex(Elem elem);
  void readFlexParts(Elem elem, Flex& flex);
  void readFlexBase(const Attributes& a, Flex& flex);
  void readFlexElasticity(Elem elem, Flex& flex);
  void readFlexPlugin(Elem elem, Flex& flex);
  void readFlexEquality(Elem elem);
  std::vector<FlexElement> flexElements(const Attributes& a, int dim, size_t points);
  std::vector<std::string> words(const Attributes& a, std::string_view name) const;
  void addFlex(Flex flex);
  void finishFlexes();
  bool isParticle(const FlexVertex& vertex, const std::vector<int>& uses) const;

  // mjcf_parser_flexcomp.cpp
  void readFlexcomp(Elem elem, const OpenElem& in);
  std::optional<FlexShape> flexcompShape(const Attributes& a, const FlexPattern& pattern);
  FlexShape gmshShape(const Attributes& a);
  FlexShape directShape(const Attributes& a, int dim);
  FlexShape meshShape(const Attributes& a, int dim);
  FlexPattern flexPattern(const Attributes& a, FlexKind kind, int dim, double radius);
  std::vector<bool> flexPins(Elem elem, const FlexPattern& pattern, size_t points);
  void pinGrid(const Attributes& a, bool ranges, const FlexPattern& pattern, std::vector<bool>& pinned);
  int addPoint(const std::string& name, const std::string& where, Posed pose, int parent);
  void slide(int body, Vec3d axis, const Joint& like);
  void chargePoints(const Attributes& a, std::string_view attribute, double count);

  // mjcf_parser_composite.cpp
  void readComposite(Elem elem, const OpenElem& in);
  void readCompositeParts(Composite& c);
  void readCompositeJoint(Elem elem, Composite& c);
  void needCount(const Composite& c, size_t least, size_t most, int fewest);
  void addGrid(Composite& c, const OpenElem& in);
  void addCloth(Composite& c, const OpenElem& in);
  int addElement(const Composite& c, const std::string& name, Vec3d at, const OpenElem& in);
  void joinGrid(const Composite& c, Flex flex);
  std::vector<int> rootElement(const Composite& c, const OpenElem& in, size_t numbers);

  // mjcf_parser_chain.cpp: ropes, loops and cables
  void addRope(Composite& c, const OpenElem& in);
  int addLink(const Composite& c, const std::string& number, const Posed& pose, int parent);
  void addCable(Composite& c, const OpenElem& in);
  std::vector<Vec3d> cablePoints(Composite& c);
  std::vector<Vec3d> curvePoints(Composite& c);
  Geom cableGeom(const Composite& c, double size);
  void addCableSite(const Composite& c, const char* name, int body, Vec3d at);

  // mjcf_parser_joints.cpp
  void readJoint(Elem elem, const OpenElem& in, bool isFree);
  void checkAmong(Elem elem, const Body& body, const Joint& joint);
  void readJointRange(const Attributes& a, Joint& joint);
  void readJointForces(const Attributes& a, Joint& joint);
  double angleUnit(JointKind kind) const;
  bool isLimited(const Attributes& a, std::string_view flag, std::string_view range);
  double notNegative(const Attributes& a, std::string_view name, size_t most = 1);
  double firstOf(const Attributes& a, std::string_view name);
  double largerOf(const Attributes& a, std::string_view range);

  // mjcf_parser_tendons.cpp
  void readTendons(Elem elem);
  void readTendon(Elem elem);
  void readFixed(Elem elem, Tendon& tendon);
  void readSpatial(Elem elem, Tendon& tendon);
  std::optional<JointRef> scalarJoint(const Attributes& a, std::string_view attribute);
  int siteNamed(const Attributes& a, std::string_view attribute);
  int tendonNamed(const Attributes& a, std::string_view attribute);

  // mjcf_parser_actuators.cpp
  void readActuators(Elem elem);
  void readActuator(Elem elem);
  void readTransmission(const Attributes& a, Actuation& actuation);
  void readLaw(const Attributes& a, Actuation& actuation);
  void readGeneralLaw(const Attributes& a, Actuation& actuation);
  void readServo(const Attributes& a, Actuation& actuation);
  void readActuatorRanges(const Attributes& a, Actuation& actuation);
  void leaveOut(Actuation& actuation, const std::string& why);

  // mjcf_parser_sensors.cpp
  void readSensors(Elem elem);
  void readSensor(Elem elem);
  bool aimSensor(const Attributes& a, Sensor& sensor);
  bool aimAtJoint(const Attributes& a, Sensor& sensor);
  bool aimAtRange(const Attributes& a, const Sensor& sensor);
  bool aimAtActuator(const Attributes& a, Sensor& sensor);
  bool aimAtFrame(const Attributes& a, Sensor& sensor);
  std::optional<SensorFrame> sensorFrame(const Attributes& a, const std::string& prefix, bool axes);
  void leaveOut(const Attributes& a, const std::string& why);

  // mjcf_parser_geoms.cpp
  void readGeom(Elem elem, const OpenElem& in);
  void readShape(const Attributes& a, Geom& geom);
  void applyFromTo(const Attributes& a, Geom& geom);
  void readSurface(const Attributes& a, Geom& geom);
  void readGeomMass(const Attributes& a, Geom& geom);
  void readColor(const Attributes& a, Geom& geom);
  void checkReference(const Attributes& a, std::string_view attribute);
  void readAssetShape(const Attributes& a, Geom& geom);

  // mjcf_parser_masses.cpp: once all bodies are known
  void finishMasses();
  void finishMass(size_t body);
  void limitMass(size_t body);
  void scaleTotalMass();

  // mjcf_parser_links.cpp: what joins and separates bodies, keyframes
  void readContact(Elem elem);
  void readExclude(Elem elem);
  void readPair(Elem elem);
  void readEqualities(Elem elem);
  void readEquality(Elem elem);
  bool readHold(const Attributes& a, Equality& equality);
  bool holdAtSites(const Attributes& a, Equality& equality);
  bool readRelation(const Attributes& a, Equality& equality);
  bool readDistance(const Attributes& a, Equality& equality);
  void readKeys(Elem elem);
  std::vector<double> keyNumbers(const Attributes& a, std::string_view name, size_t count);
  int bodyNamed(const Attributes& a, std::string_view attribute);
  std::optional<GeomRef> geomNamed(const Attributes& a, std::string_view attribute);
  bool mayBeLeftOut(const Attributes& a, std::string_view attribute);

  XmlSource source_;
  Notes notes_;
  Defaults defaults_;
  Compiler compiler_;
  Description out_;
  std::vector<Inertial> inertials_;  // of out_.bodies
  std::vector<Elem> bodyElems_;      // of out_.bodies
  std::map<std::string, int, std::less<>> bodyByName_{{"world", 0}};
  std::map<std::string, GeomRef, std::less<>> geomByName_;
  std::map<std::string, JointRef, std::less<>> jointByName_;
  std::map<std::string, int, std::less<>> siteByName_, tendonByName_;  // into out_.sites and tendons
  std::set<std::string, std::less<>> jointNames_, siteNames_, tendonNames_, actuatorNames_;
  std::map<std::string, size_t, std::less<>> flexByName_;   // into out_.flexes
  size_t points_ = 0;                                       // of flexes and composites
  std::map<std::string, int, std::less<>> actuatorByName_;  // into out_.actuations
  std::set<std::string, std::less<>> sensorNames_, equalityNames_, keyNames_, pairNames_, excludeNames_;
  std::map<std::string, std::set<std::string, std::less<>>, std::less<>> assets_;  // names by element
  std::vector<MeshSource> meshSources_;                                            // of out_.meshes
  std::map<std::string, size_t, std::less<>> meshByName_, heightsByName_;          // into out_.meshes and heights
  std::map<std::string, std::optional<Color>, std::less<>> materials_;
  size_t assetBytes_ = 0, sensorCount_ = 0;
  bool coordinatesMissing_ = false;  // something left out would have brought coordinates of its own
  SwitchedOff off_;
};

}  // namespace avbd::mjcf
