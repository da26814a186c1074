// The reader behind urdf_parse.h: walks the elements and fills a Description.
#pragma once

#include <map>

#include "io/urdf_parse.h"
#include "io/urdf_source.h"

namespace avbd::urdf {

class Parser {
 public:
  Parser(const Source& source, Description& out) : source_(source), out_(out) {}
  void parse();

 private:
  using Names = std::map<std::string, int, std::less<>>;

  void readLink(Elem elem);
  void readInertial(Elem elem, Link& link);
  mjcf::Sym3d readInertia(Elem elem, Elem inertial, const Posed& pose, Link& link);
  std::vector<Shape> readShapes(Elem link, std::string_view name);
  std::optional<Shape> readShape(Elem elem);
  void readSize(Elem elem, Shape& shape);
  void readMesh(Elem elem, Shape& shape);
  std::optional<Color> readColor(Elem material);
  void readMaterials(const std::vector<Elem>& parts);
  std::optional<Color> readMaterial(Elem elem);
  void readContact(Elem elem, Link& link);
  void readGazebo(Elem elem);
  Posed readOrigin(Elem parent);

  void readJoint(Elem elem);
  JointKind readKind(Elem elem);
  int linkOf(Elem joint, const char* element);
  void readAxis(Elem elem, Joint& joint);
  void readLimit(Elem elem, Joint& joint);
  void readDynamics(Elem elem, Joint& joint);
  void boundLimit(Elem elem, const Joint& joint, Limit& limit);
  void readMimic(Elem elem, Joint& joint);
  void dropMimicLoops();
  void resolveMimics();
  void setStarts();
  void setMimicStart(size_t joint);
  void readTransmission(Elem elem);
  double readReduction(Elem elem, double otherwise);

  void attach(size_t joint);
  void attachToWorld(size_t joint);
  void connect(Elem robot);
  void refuseLoops(int root) const;

  void note(Elem elem, const std::string& what) { out_.notes.add(source_.where(elem), what); }
  /// Counted once for all elements of this name.
  void noteUnused(Elem elem, const std::string& what);

  const Source& source_;
  Description& out_;
  Names linksByName_, jointsByName_;
  std::map<std::string, std::optional<Color>, std::less<>> materials_;
  std::vector<Elem> linkElems_, jointElems_;
};

}  // namespace avbd::urdf
