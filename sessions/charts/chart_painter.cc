#include "sessions/charts/chart_painter.h"

#include <duktape.h>

#include <cstdlib>
#include <memory>
#include <string_view>

#include "core/error.h"
#include "sessions/charts/chart_option.h"
#include "web/bundle.h"

namespace elbowroom::sessions {
namespace {

// What the library asks for of a browser or of Node; without animations no timer ever runs.
constexpr std::string_view kSurroundings =
    "var self = this, global = this;"
    "function setTimeout() {} function clearTimeout() {} function setInterval() {} function clearInterval() "
    "{}";

// Only what fails outside of a protected call comes here: the heap is out of memory.
[[noreturn]] void EndProgram(void*, const char*) { std::abort(); }

// A character beyond U+FFFF is two surrogates of three bytes each in Duktape; half of one means nothing.
std::string WithoutSurrogates(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const auto begins = [&](std::size_t i, unsigned first) {
    return byte(i) == 0xEDU && (byte(i + 1) & 0xF0U) == first;
  };
  std::string utf8;
  utf8.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    if (begins(i, 0xA0U) && begins(i + 3, 0xB0U)) {
      const unsigned high = (byte(i + 1) & 0x0FU) << 6U | (byte(i + 2) & 0x3FU);
      const unsigned low = (byte(i + 4) & 0x0FU) << 6U | (byte(i + 5) & 0x3FU);
      const unsigned code = 0x10000U + (high << 10U | low);
      for (const unsigned unit : {0xF0U | code >> 18U, 0x80U | (code >> 12U & 0x3FU),
                                  0x80U | (code >> 6U & 0x3FU), 0x80U | (code & 0x3FU)})
        utf8 += static_cast<char>(unit);
      i += 6;
    } else if (begins(i, 0xA0U) || begins(i, 0xB0U)) {
      utf8 += "\uFFFD";
      i += 3;
    } else {
      utf8 += text[i++];
    }
  }
  return utf8;
}

}  // namespace

// Calls of Duktape's C functions are protected: an error in the script never unwinds this code.
class ChartPainter::Engine {
 public:
  Engine() : heap_(duk_create_heap(nullptr, nullptr, nullptr, nullptr, EndProgram), duk_destroy_heap) {
    core::Require(heap_ != nullptr, "there is memory for the charts");
    Run(kSurroundings);
    Run(web::ChartScript());
  }

  [[nodiscard]] std::string Draw(const std::string& option, double width_px, double height_px) {
    duk_context* const context = heap_.get();
    duk_get_global_string(context, "elbowroomCharts");
    duk_push_string(context, "drawSvg");
    duk_push_lstring(context, option.data(), option.size());
    duk_push_number(context, width_px);
    duk_push_number(context, height_px);
    if (duk_pcall_prop(context, -5, 3) != DUK_EXEC_SUCCESS) Fail();
    std::size_t size = 0;
    const char* const text = duk_get_lstring(context, -1, &size);
    std::string svg = WithoutSurrogates({text == nullptr ? "" : text, size});
    duk_set_top(context, 0);
    return svg;
  }

 private:
  void Run(std::string_view script) {
    if (duk_peval_lstring(heap_.get(), script.data(), script.size()) != 0) Fail();
    duk_pop(heap_.get());
  }

  [[noreturn]] void Fail() {
    const std::string what = duk_safe_to_string(heap_.get(), -1);
    duk_set_top(heap_.get(), 0);
    throw core::PreconditionError("a chart can be drawn: " + what);
  }

  std::unique_ptr<duk_context, void (*)(duk_context*)> heap_;
};

ChartPainter::ChartPainter() : engine_(std::make_unique<Engine>()) {}
ChartPainter::~ChartPainter() = default;
ChartPainter::ChartPainter(ChartPainter&&) noexcept = default;
ChartPainter& ChartPainter::operator=(ChartPainter&&) noexcept = default;

std::string ChartPainter::Svg(const Chart& chart, double width_px) {
  return engine_->Draw(OptionJson(chart), width_px, HeightOf(chart));
}

}  // namespace elbowroom::sessions
