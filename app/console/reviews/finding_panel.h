// The list of touches and near misses, with what is shown of it.
#pragma once

#include <QComboBox>
#include <QLabel>
#include <QTableView>
#include <QWidget>
#include <cstddef>
#include <optional>
#include <set>
#include <vector>

#include "app/console/reviews/finding_model.h"

namespace elbowroom::console {

// Thread: UI.
class FindingPanel : public QWidget {
  Q_OBJECT

 public:
  explicit FindingPanel(QWidget* parent = nullptr);

  // Keeps what is chosen, where it is still there.
  void Open(const std::vector<control::ListedFinding>& findings);
  void Forget() { chosen_.reset(); }  // what is chosen
  void ShowVanished(std::set<std::size_t> vanished, const QString& gaps);
  void Choose(std::size_t finding);  // does nothing where it isn't shown
  [[nodiscard]] std::optional<std::size_t> chosen() const { return chosen_; }  // its place in the list

 signals:
  void Chosen(std::size_t finding);  // by the user, or by Choose()

 private:
  void Filter();
  void ListParts(const std::vector<control::ListedFinding>& findings);
  void TakeChoice();
  void ShowCounts();

  FindingModel* model_;
  FindingFilter* filter_;
  QComboBox* status_;
  QComboBox* part_;
  QLabel* counts_;
  QTableView* list_;
  std::optional<std::size_t> chosen_;
};

}  // namespace elbowroom::console
