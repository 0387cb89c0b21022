#include "app/console/layouts/layout_page.h"

namespace elbowroom::console {

LayoutPage::LayoutPage(QWidget* parent) : QWidget(parent) {}

void LayoutPage::Open(const std::filesystem::path& /*layout_file*/) {}

}  // namespace elbowroom::console
