#pragma once

// Meshes: simple shapes, files, checks.
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
