#pragma once

// Flights of many bodies on several threads.
#include "bullet_ambient/base/task_runner.h"
#include "bullet_ambient/bullet/world/bullet_task_runner.h"
