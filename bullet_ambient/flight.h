#pragma once

// FlightSettings: integrator and tolerance of one body.
#include "bullet_ambient/motion/flight/flight_settings.h"
