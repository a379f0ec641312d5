// Moved to engine/, where models may include it as well.
#pragma once

#include "engine/json_position.h"
