// The text of a photometric file: its table is looked up and integrated.
#include "scene/readers/ies_file.hpp"
#include "tests/fuzz/check_table.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    fluxel::check_table(fluxel::read_ies_text("lamp.ies", text).table);
  } catch (const fluxel::InputError&) {  // how bad input is to be told
  }
  return 0;
}
