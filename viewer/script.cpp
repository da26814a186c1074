// The bundled viewer as bytes of the library: dist/viewer.js, taken in by the assembler.
#include <string_view>

extern "C" {
extern const char avbdViewerScriptBegin[];
extern const char avbdViewerScriptEnd[];
}

asm(R"(
  .pushsection .rodata
  .global avbdViewerScriptBegin
  .global avbdViewerScriptEnd
avbdViewerScriptBegin:
  .incbin ")" AVBD_VIEWER_SCRIPT R"("
avbdViewerScriptEnd:
  .byte 0
  .popsection
)");

namespace avbd {

std::string_view viewerScript() {
  return {avbdViewerScriptBegin, static_cast<size_t>(avbdViewerScriptEnd - avbdViewerScriptBegin)};
}

}  // namespace avbd
