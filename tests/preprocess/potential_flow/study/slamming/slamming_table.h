#pragma once

#include <string>

namespace ambient::study {

/// Markdown: force on a ball against its depth at constant speed. Runtime, closed forms and a
/// measurement.
std::string ballTable();

/// Markdown: mean force per length since first contact on wedges of `length` [m], 2 m wide at the
/// deck. Runtime and theories.
std::string wedgeTable(double length);

/// Markdown: force F / (rho V^3 t) at the moment on a wedge that falls in a Bullet world.
std::string wedgeFallTable(double degrees, double length);

}  // namespace ambient::study
