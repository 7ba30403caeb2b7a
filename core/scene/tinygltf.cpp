#include <fstream>  // which tinygltf's writers need and its header leaves out without file access

#define TINYGLTF_IMPLEMENTATION
#include "core/scene/tinygltf.h"
