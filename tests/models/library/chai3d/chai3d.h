// The part of CHAI3D 3 that assets/examples/chai3d uses: a double with a half space, solid below z = 0.
#pragma once

#include <cmath>

namespace chai3d {

constexpr int C_EFFECT_MAX_IDN = 16;

struct cVector3d {
  double x = 0.0, y = 0.0, z = 0.0;
  void zero() { *this = {}; }
  void mul(double factor) { *this = {factor * x, factor * y, factor * z}; }
  double length() const { return std::sqrt(x * x + y * y + z * z); }
  friend cVector3d operator-(const cVector3d& a, const cVector3d& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
};

struct cGenericObject {
  bool m_interactionInside = false;
  cVector3d m_interactionPoint;
};

class cGenericEffect {
 public:
  explicit cGenericEffect(cGenericObject* parent) : m_parent(parent) {}
  virtual ~cGenericEffect() = default;
  virtual bool computeForce(const cVector3d&, const cVector3d&, const unsigned int&, cVector3d&) { return false; }
  cGenericObject* m_parent;
};

}  // namespace chai3d
