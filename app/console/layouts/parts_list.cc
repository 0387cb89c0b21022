#include "app/console/layouts/parts_list.h"

#include <QHeaderView>
#include <QSignalBlocker>
#include <filesystem>

namespace elbowroom::console {
namespace {

constexpr int kMostChosen = 2;
constexpr int kNameRole = Qt::UserRole;  // as the layout has it

QPixmap Swatch(const QColor& color) {
  QPixmap swatch(12, 12);
  swatch.fill(color);
  return swatch;
}

}  // namespace

QStringList WithClick(const QStringList& chosen, const QString& part, bool adds) {
  if (part.isEmpty()) return adds ? chosen : QStringList();
  if (!adds) return {part};
  QStringList now = chosen;
  if (now.removeAll(part) > 0) return now;
  while (now.size() >= kMostChosen) now.removeLast();  // the first one stays
  return now << part;
}

PartsList::PartsList(QWidget* parent) : QTreeWidget(parent) {
  setObjectName("parts");
  setAccessibleName(tr("Parts"));
  setToolTip(tr("A tick shows a part. Click: choose; Ctrl+click: a second part; F2: rename"));
  setHeaderLabels({tr("Part"), tr("File")});
  header()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
  setRootIsDecorated(false);
  setSelectionMode(ExtendedSelection);
  setEditTriggers(EditKeyPressed);
  connect(this, &QTreeWidget::itemSelectionChanged, this, &PartsList::TakeSelection);
  connect(this, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item) {
    const QString name = item->data(0, kNameRole).toString();
    if (item->text(0) != name) return emit RenameAsked(name, item->text(0));
    emit VisibilityChanged(name, item->checkState(0) == Qt::Checked);
  });
}

void PartsList::Show(const core::Layout& layout, const PartLooks& looks, const QStringList& chosen) {
  const QSignalBlocker blocker(this);
  chosen_ = chosen;
  while (topLevelItemCount() > static_cast<int>(layout.parts.size())) delete topLevelItem(0);
  while (topLevelItemCount() < static_cast<int>(layout.parts.size())) addTopLevelItem(new QTreeWidgetItem);
  for (std::size_t i = 0; i < layout.parts.size(); ++i) {
    const core::Part& part = layout.parts[i];
    const QString name = QString::fromStdString(part.name);
    const auto found = looks.find(name);
    const PartLook look = found == looks.end() ? PartLook() : found->second;
    QTreeWidgetItem* item = topLevelItem(static_cast<int>(i));
    item->setText(0, name);
    item->setData(0, kNameRole, name);
    item->setFlags(item->flags() | Qt::ItemIsEditable);
    item->setIcon(0, Swatch(look.color.isValid() ? look.color : PartColor(i)));
    item->setCheckState(0, look.is_visible ? Qt::Checked : Qt::Unchecked);
    item->setText(1, QString::fromStdString(std::filesystem::path(part.file).filename().string()));
    item->setToolTip(1, part.node.empty() ? QString::fromStdString(part.file)
                                          : QString::fromStdString(part.file + "\n" + part.node));
    item->setSelected(chosen.contains(name));
  }
}

void PartsList::TakeSelection() {
  QStringList selected;
  for (const QTreeWidgetItem* item : selectedItems()) selected << item->text(0);
  QStringList now;
  for (const QString& part : chosen_)
    if (selected.contains(part)) now << part;
  for (const QString& part : selected) {
    if (now.contains(part)) continue;
    while (now.size() >= kMostChosen) now.removeLast();
    now << part;
  }
  emit Chosen(now);
}

}  // namespace elbowroom::console
