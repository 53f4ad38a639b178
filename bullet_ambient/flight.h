#pragma once

// FlightSettings: tolerance and substeps of one body.
#include "bullet_ambient/motion/flight/flight_settings.h"
