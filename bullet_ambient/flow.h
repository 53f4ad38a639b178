#pragma once

// FlowSettings: pressure law, separation, friction of one body.
#include "bullet_ambient/force/law/flow_settings.h"
