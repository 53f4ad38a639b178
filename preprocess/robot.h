#pragma once

// Robots from URDF files as btMultiBody in a fluid.
#include "preprocess/robot/robot.h"
#include "preprocess/robot/robot_model.h"
