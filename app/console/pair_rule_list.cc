#include "app/console/pair_rule_list.h"

#include <QEvent>
#include <QVBoxLayout>
#include <algorithm>
#include <tuple>
#include <utility>

#include "app/console/desktop/theme.h"
#include "app/console/lower_bound_text.h"
#include "app/console/view/verdict_word.h"

namespace elbowroom::console {
namespace {

// The words say the same: nobody needs to tell the colours apart.
QColor ColorOf(const review::PairClash& pair) {
  if (!control::IsBroken(pair)) return ThemeColors().clear;
  return pair.verdict == core::Verdict::kContact ? ThemeColors().contact : ThemeColors().attention;
}

// How many rules aren't shown.
QString OthersText(std::span<const review::PairClash* const> pairs) {
  const auto broken =
      std::ranges::count_if(pairs, [](const review::PairClash* pair) { return control::IsBroken(*pair); });
  return PairRuleList::tr("and %1 more, %2 of them broken").arg(pairs.size()).arg(broken);
}

double Margin_mm(const review::PairClash& pair) { return pair.at_least_mm - pair.demand.required_mm; }

}  // namespace

PairRuleList::PairRuleList(const core::Layout& layout, std::vector<std::size_t> shown, bool only_broken,
                           QWidget* parent)
    : QWidget(parent), shown_(std::move(shown)), only_broken_(only_broken) {
  for (const core::Part& part : layout.parts) part_names_.push_back(QString::fromStdString(part.name));
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(1);
  for (std::size_t i = 0; i < std::min(shown_.size(), kMostLines + 1); ++i) {
    auto* line = new QLabel;
    line->setObjectName(QString("pair_rule:%1").arg(i));
    line->setTextFormat(Qt::PlainText);
    line->setWordWrap(true);
    line->setToolTip(
        tr("A pair rule of the layout, judged at the gap of the latest frame: the distance between "
           "the surfaces of two parts in mm, and what the rule requires"));
    column->addWidget(line);
    lines_.push_back(line);
  }
  for (std::size_t i = 0; i < lines_.size(); ++i)
    ShowLine(i, i == 0 && !only_broken_ ? tr("pair rules: not judged yet") : QString(),
             ThemeColors().quiet_text);
  setHidden(texts().isEmpty());
}

QString PairRuleList::TextOf(const review::PairClash& pair) const {
  const QString number = LowerBoundText(pair.at_least_mm + review::kTouchMm);
  QString distance = pair.gap ? tr("%1 mm").arg(number) : tr("≥ %1 mm").arg(number);
  if (pair.contained) distance = tr("one inside the other");
  const QString names = tr("%1 and %2").arg(part_names_[pair.demand.a], part_names_[pair.demand.b]);
  const QString required = QString::number(pair.demand.required_mm, 'g');
  const bool is_broken = control::IsBroken(pair);
  return tr("%1 %2: %3, %4; %5", "sign, parts, distance, verdict, whether the rule is kept")
      .arg(QString::fromUtf8(is_broken ? "✕" : "✓"), names, distance, VerdictWord(pair.verdict),
           is_broken ? tr("rule of %1 mm broken").arg(required) : tr("rule of %1 mm kept").arg(required));
}

std::vector<const review::PairClash*> PairRuleList::InOrder(const control::PairVerdicts& verdicts) const {
  std::vector<const review::PairClash*> pairs;
  for (const std::size_t i : shown_)
    if (!only_broken_ || control::IsBroken(verdicts.pairs[i])) pairs.push_back(&verdicts.pairs[i]);
  const auto first = pairs.begin() + static_cast<std::ptrdiff_t>(std::min(pairs.size(), kMostLines));
  std::ranges::partial_sort(pairs, first, {}, [](const review::PairClash* pair) {
    return std::tuple(!control::IsBroken(*pair), Margin_mm(*pair), pair);
  });
  return pairs;
}

void PairRuleList::ShowVerdicts(const control::SharedPairVerdicts& verdicts,
                                std::span<const double> spacing_mm) {
  if (!verdicts || lines_.empty()) return;
  const bool is_of_frame = std::ranges::equal(verdicts->setting.spacing_mm, spacing_mm);
  if (verdicts == verdicts_ && is_of_frame == is_of_frame_) return;
  verdicts_ = verdicts;
  is_of_frame_ = is_of_frame;
  ShowLines();
}

void PairRuleList::ShowLines() {
  const std::vector<const review::PairClash*> pairs = InOrder(*verdicts_);
  const QString of_before = is_of_frame_ ? QString() : tr(" (at the gap before; this one is being judged)");
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (i >= pairs.size()) {
      ShowLine(i, {}, ThemeColors().quiet_text);
    } else if (i == kMostLines) {
      ShowLine(i, OthersText(std::span(pairs).subspan(i)), ThemeColors().quiet_text);
    } else {
      ShowLine(i, TextOf(*pairs[i]) + of_before,
               is_of_frame_ ? ColorOf(*pairs[i]) : ThemeColors().quiet_text);
    }
  }
  setHidden(texts().isEmpty());
}

void PairRuleList::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange && verdicts_) ShowLines();  // another theme's colours
}

void PairRuleList::ShowLine(std::size_t line, const QString& text, const QColor& color) {
  QLabel& label = *lines_[line];
  label.setText(text);
  label.setAccessibleName(text.isEmpty() ? QString() : tr("Pair rule: %1").arg(text));
  label.setStyleSheet("color: " + color.name());
  label.setHidden(text.isEmpty());
}

QStringList PairRuleList::texts() const {
  QStringList texts;
  for (const QLabel* line : lines_)
    if (!line->text().isEmpty()) texts.push_back(line->text());
  return texts;
}

}  // namespace elbowroom::console
