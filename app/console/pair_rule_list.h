// Pair rules beside the spacing that moves their parts.
#pragma once

#include <QLabel>
#include <QString>
#include <QWidget>
#include <cstddef>
#include <span>
#include <vector>

#include "app/control/pairs/pair_judge.h"
#include "core/layout.h"

namespace elbowroom::console {

// One line a rule, broken ones first, then those nearest to being broken: the parts, the distance of their
// surfaces, the verdict in words, what is required. At most kMostLines; the last line says how many more
// there are. Thread: UI.
class PairRuleList : public QWidget {
  Q_OBJECT

 public:
  static constexpr std::size_t kMostLines = 3;

  // shown: positions of the pairs in PairVerdicts::pairs. only_broken: rules that are kept aren't shown.
  PairRuleList(const core::Layout& layout, std::vector<std::size_t> shown, bool only_broken = false,
               QWidget* parent = nullptr);

  // Null: none was judged yet. spacing_mm: those of the frame; verdicts of another setting are shown as such.
  void ShowVerdicts(const control::SharedPairVerdicts& verdicts, std::span<const double> spacing_mm);

  [[nodiscard]] QStringList texts() const;  // of the lines that are shown

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void ShowLines();
  void ShowLine(std::size_t line, const QString& text, const QColor& color);
  [[nodiscard]] QString TextOf(const review::PairClash& pair) const;
  [[nodiscard]] std::vector<const review::PairClash*> InOrder(const control::PairVerdicts& verdicts) const;

  std::vector<QString> part_names_;
  std::vector<std::size_t> shown_;
  bool only_broken_;
  control::SharedPairVerdicts verdicts_;  // that the lines show
  bool is_of_frame_ = false;              // and whether these are of the frame's setting
  std::vector<QLabel*> lines_;            // owned by Qt as children
};

}  // namespace elbowroom::console
