#include <signorini/collision/mesh_file.h>

#include <fstream>

int main() {
  std::ofstream("triangle.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  return signorini::collision::read_mesh_file("triangle.obj").triangles.size() == 1 ? 0 : 1;
}
