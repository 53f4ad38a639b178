#pragma once

#include <string>

namespace ambient::study {

/// Force on a ball over its depth at constant speed: the runtime, closed forms and a measurement;
/// as Markdown.
std::string ballTable();

/// Mean force from the touch on, on wedges so long [m] and 2 m wide at the deck, per length, beside
/// theories; as Markdown.
std::string wedgeTable(double length);

/// The same of a wedge that falls in a Bullet world, F / (rho V^3 t) at the moment; as Markdown.
std::string wedgeFallTable(double degrees, double length);

}  // namespace ambient::study
