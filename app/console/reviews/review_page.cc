#include "app/console/reviews/review_page.h"

namespace elbowroom::console {

ReviewPage::ReviewPage(QWidget* parent) : QWidget(parent) {}

void ReviewPage::Open(const std::filesystem::path& /*session*/) {}

}  // namespace elbowroom::console
