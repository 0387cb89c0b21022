#include "app/console/reviews/finding_panel.h"

#include <QHBoxLayout>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>

#include "app/console/view/listing.h"

namespace elbowroom::console {

FindingPanel::FindingPanel(QWidget* parent)
    : QWidget(parent),
      model_(new FindingModel(this)),
      filter_(new FindingFilter(this)),
      status_(new QComboBox),
      part_(new QComboBox),
      counts_(new QLabel) {
  filter_->setSourceModel(model_);
  status_->setObjectName("finding_status_filter");
  status_->setAccessibleName(tr("Status shown"));
  status_->setToolTip(tr("List only touches and near misses of this status"));
  status_->addItem(tr("any status"));
  for (const core::ReviewStatus status : core::kReviewStatuses)
    status_->addItem(StatusText(status), static_cast<int>(status));
  part_->setObjectName("finding_part_filter");
  part_->setAccessibleName(tr("Part shown"));
  part_->setToolTip(tr("List only touches and near misses of this part"));
  part_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  part_->setMinimumContentsLength(8);
  counts_->setForegroundRole(QPalette::PlaceholderText);
  auto* list = new Listing(filter_, tr("No touch and no near miss"), FindingModel::kPart);
  list_ = list;
  list->setObjectName("finding_list");
  list->setAccessibleName(tr("Touches and near misses"));
  list->setFocusPolicy(Qt::StrongFocus);
  list->setSelectionMode(QAbstractItemView::SingleSelection);
  list->setSelectionBehavior(QAbstractItemView::SelectRows);
  list->setTabKeyNavigation(false);
  auto* filters = new QHBoxLayout;
  filters->addWidget(status_);
  filters->addWidget(part_);
  filters->addWidget(counts_, 1);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addLayout(filters);
  column->addWidget(list_, 1);
  connect(status_, &QComboBox::currentIndexChanged, this, &FindingPanel::Filter);
  connect(part_, &QComboBox::currentIndexChanged, this, &FindingPanel::Filter);
  connect(list_->selectionModel(), &QItemSelectionModel::currentRowChanged, this, &FindingPanel::TakeChoice);
}

void FindingPanel::Open(const std::vector<control::ListedFinding>& findings) {
  const std::optional<std::size_t> chosen = chosen_;
  {
    const QSignalBlocker list_is_quiet(list_->selectionModel());
    ListParts(findings);
    model_->Open(findings);
    Filter();
  }
  chosen_.reset();
  if (chosen) Choose(*chosen);
  if (!chosen_ && chosen && *chosen < findings.size()) chosen_ = chosen;  // its status is filtered out now
}

void FindingPanel::ListParts(const std::vector<control::ListedFinding>& findings) {
  QStringList names;
  for (const control::ListedFinding& listed : findings) names << QString::fromStdString(listed.finding.part);
  names.removeDuplicates();
  names.sort();
  const QSignalBlocker part_is_quiet(part_);
  const QString last = part_->currentIndex() > 0 ? part_->currentText() : QString();
  part_->clear();
  part_->addItem(tr("any part"));
  part_->addItems(names);
  part_->setCurrentIndex(std::max(0, part_->findText(last)));
}

void FindingPanel::Filter() {
  const QVariant status = status_->currentData();
  filter_->ShowOnly(
      status.isValid() ? std::optional(static_cast<core::ReviewStatus>(status.toInt())) : std::nullopt,
      part_->currentIndex() > 0 ? part_->currentText() : QString());
  ShowCounts();
}

void FindingPanel::ShowCounts() {
  counts_->setText(tr("%1 of %2").arg(filter_->rowCount()).arg(model_->rowCount()));
}

void FindingPanel::ShowVanished(std::set<std::size_t> vanished, const QString& gaps) {
  model_->ShowVanished(std::move(vanished), gaps);
}

void FindingPanel::Choose(std::size_t finding) {
  if (finding >= model_->findings().size()) return;
  const QModelIndex at = filter_->mapFromSource(model_->index(static_cast<int>(finding), 0));
  if (!at.isValid()) return;
  list_->setCurrentIndex(at);
  list_->scrollTo(at);
}

void FindingPanel::TakeChoice() {
  const QModelIndex at = filter_->mapToSource(list_->currentIndex());
  if (!at.isValid()) return;
  chosen_ = static_cast<std::size_t>(at.row());
  emit Chosen(*chosen_);
}

}  // namespace elbowroom::console
