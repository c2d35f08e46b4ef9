#pragma once
// Questions about models: nearest points, points inside, areas and volumes, sections by planes. Each header can be
// included alone; measures.h and sections.h need no Embree.

#include "tessera/measures.h"
#include "tessera/nearest_curves.h"
#include "tessera/nearest_points.h"
#include "tessera/sections.h"
#include "tessera/solid.h"
