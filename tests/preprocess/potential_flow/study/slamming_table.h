#pragma once

#include <string>

namespace ambient::study {

/// Force on a ball over its depth at constant speed: the runtime, closed forms and a measurement;
/// as Markdown.
std::string ballTable();

/// Force on wedges so long [m] and 2 m wide at the deck, per length, beside theories; as Markdown.
std::string wedgeTable(double length);

}  // namespace ambient::study
