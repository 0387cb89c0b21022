// What a reader of PDF files finds in one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace elbowroom::tests {

// Poppler and qpdf, which the tests read PDF files with.
[[nodiscard]] bool HasPdfReaders();

// The text of each page, in the order in which it was drawn.
[[nodiscard]] std::vector<std::string> TextsOfPages(const std::filesystem::path& pdf);
[[nodiscard]] std::string TextOf(const std::filesystem::path& pdf);
// Without any white space: lines may break anywhere.
[[nodiscard]] std::string Squeezed(const std::string& text);

[[nodiscard]] std::int64_t CountOf(const std::string& text, const std::string& what);

// Fails the running test where qpdf finds a fault, or where a word reaches into the margins.
void ExpectGoodPdf(const std::filesystem::path& pdf);

}  // namespace elbowroom::tests
