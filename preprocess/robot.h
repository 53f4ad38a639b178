#pragma once

// Robots from URDF files as btMultiBody in a fluid.
#include "preprocess/robot/robot.h"
#include "preprocess/robot/urdf_reader.h"
