// SPDX-License-Identifier: MIT
// tinygltf, told to leave images alone. Only io/gltf.cpp compiles its implementation.
#pragma once

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>
