#include "bench/hard/cases.h"

namespace saccade::bench {

const std::vector<HardCaseTitle>& hardCaseTitles() {
  static const std::vector<HardCaseTitle> titles = {
      {1, "Rays of random bit patterns", ""},
      {2, "Zero or subnormal direction", ""},
      {3, "Self-shadow, thin walls, scales", ""},
      {4, "Scene far from the origin", "scenes are not recentred"},
      {5, "Unsound triangles", ""},
      {6, "Coplanar duplicates", ""},
      {7, "Lights without area", ""},
      {8, "Light of disks, rectangles and plates", ""},
      {9, "Virtual point light at no distance", "there are no virtual point lights"},
      {10, "White furnace", ""},
      {11, "Roughness towards 0", ""},
      {12, "Ward at 89.9 degrees", ""},
      {13, "Fresnel", "metals reflect by F0 and Schlick: no conductor has a complex index"},
      {14, "Reciprocity, densities of directions", ""},
      {15, "Half vector of opposite directions", ""},
      {16, "Normals that disagree", ""},
      {17, "Basis at (0, 0, -1)", ""},
      {18, "Beer-Lambert", ""},
      {19, "Random numbers of exactly 1", ""},
      {20, "More than 2^32 samples", ""},
      {21, "Images from 1 x 1 to 16384^2", ""},
      {22, "Half floats, fireflies, tone mapping", ""},
      {23, "Depth at 1 km", ""},
      {24, "Warping", ""},
      {25, "Lattice and splats", ""},
      {26, "Saliency", ""},
      {27, "Cameras where they should not be", ""},
      {28, "Threads and flush-to-zero", ""},
  };
  return titles;
}

}  // namespace saccade::bench
