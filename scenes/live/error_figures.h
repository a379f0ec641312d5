// The error figures by the path that the window may include: it sees no model.
#pragma once

#include "engine/tick/error_figures.h"
