// Solids of revolution (solid_moments.h): integrals of R^2, y R^2, y^2 R^2 and R^4 over the height.
#include <cmath>

#include "geom/solid_moments.h"

namespace avbd {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Integrals of t^i s^j from the arc's middle to the direction, s = sqrt(r^2 - t^2).
struct ArcIntegrals {
  double one, s, ss, sss, ssss, ts, tss, tts, ttss, t, tt;

  ArcIntegrals(double r, Direction d) {
    const double x = r * d.sin, c = r * d.cos, rr = r * r, xx = x * x;
    one = x;
    t = xx / 2;
    tt = xx * x / 3;
    s = (x * c + rr * angleOf(d.cos, d.sin)) / 2;
    ss = rr * x - xx * x / 3;
    sss = x * c * c * c / 4 + 0.75 * rr * s;
    ssss = rr * rr * x - 2 * rr * xx * x / 3 + xx * xx * x / 5;
    ts = -c * c * c / 3;
    tss = rr * xx / 2 - xx * xx / 4;
    tts = -x * c * c * c / 4 + rr / 4 * s;
    ttss = rr * xx * x / 3 - xx * xx * x / 5;
  }
};

}  // namespace

void Revolution::add(double area, double areaY, double areaYY, double fourth) {
  volume_ += kPi * area;
  y_ += kPi * areaY;
  yy_ += kPi * areaYY;
  // A disc's integral of x^2 is pi R^4 / 4.
  xx_ += kPi / 4 * fourth;
}

void Revolution::addCone(double y0, double low, double y1, double high) {
  // R = low + k t over t = 0 .. 1, y = y0 + h t.
  const double h = y1 - y0, k = high - low;
  const double a = low * low, b = 2 * low * k, c = k * k;
  const double i0 = a + b / 2 + c / 3, i1 = a / 2 + b / 3 + c / 4, i2 = a / 3 + b / 4 + c / 5;
  const double fourth = a * a + a * b + (2 * a * c + b * b) / 3 + b * c / 2 + c * c / 5;
  add(h * i0, h * (y0 * i0 + h * i1), h * (y0 * y0 * i0 + 2 * y0 * h * i1 + h * h * i2), h * fourth);
}

void Revolution::addArc(double y, double radius, double rounding, Direction from, Direction to) {
  const ArcIntegrals a(rounding, from), b(rounding, to);
  const double q = radius, qq = q * q;
  const double i0 = qq * (b.one - a.one) + 2 * q * (b.s - a.s) + (b.ss - a.ss);
  const double i1 = qq * (b.t - a.t) + 2 * q * (b.ts - a.ts) + (b.tss - a.tss);
  const double i2 = qq * (b.tt - a.tt) + 2 * q * (b.tts - a.tts) + (b.ttss - a.ttss);
  const double fourth = qq * qq * (b.one - a.one) + 4 * qq * q * (b.s - a.s) + 6 * qq * (b.ss - a.ss) +
                        4 * q * (b.sss - a.sss) + (b.ssss - a.ssss);
  add(i0, y * i0 + i1, y * y * i0 + 2 * y * i1 + i2, fourth);
}

SolidMoments Revolution::moments() const {
  if (!(volume_ > 0)) return {};
  const double c = y_ / volume_;
  return {volume_, {0, c, 0}, {xx_, yy_ - volume_ * c * c, xx_, 0, 0, 0}};
}

}  // namespace avbd
