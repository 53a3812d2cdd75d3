// Writes the world of saved_world.h as a .bullet file, in single precision: save_world FILE

#include "saved_world.h"

#include <fstream>

int main(int argc, char** argv) {
  if (argc != 2) return 64;
  signorini::validation::SavedWorld world;
  const std::string bytes = world.bytes();
  std::ofstream file(argv[1], std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file.good() ? 0 : 1;
}
