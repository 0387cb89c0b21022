#include "app/console/view/listing.h"

#include <QHeaderView>
#include <QPainter>
#include <algorithm>
#include <utility>

#include "app/console/desktop/theme.h"
#include "app/console/view/name_delegate.h"

namespace elbowroom::console {
namespace {

constexpr int kAroundTextPx = 8;

}  // namespace

Listing::Listing(QAbstractItemModel* model, QString empty_text, int name_column, QWidget* parent)
    : QTableView(parent), empty_text_(std::move(empty_text)), name_column_(name_column) {
  setModel(model);
  setItemDelegateForColumn(name_column_, new NameDelegate(this));
  setFocusPolicy(Qt::NoFocus);
  setSelectionMode(QAbstractItemView::NoSelection);
  setEditTriggers(QAbstractItemView::NoEditTriggers);
  setShowGrid(false);
  verticalHeader()->hide();
  verticalHeader()->setDefaultSectionSize(fontMetrics().height() + kAroundTextPx);
  horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  horizontalHeader()->setSectionResizeMode(name_column_, QHeaderView::Stretch);
  horizontalHeader()->setHighlightSections(false);
  // Later: a column that stretches says so before it has its new width.
  connect(
      horizontalHeader(), &QHeaderView::sectionResized, this,
      [this](int column) {
        if (column == name_column_) FitAllRows();
      },
      Qt::QueuedConnection);
  connect(model, &QAbstractItemModel::modelReset, this, &Listing::FitAllRows);
  connect(model, &QAbstractItemModel::layoutChanged, this, &Listing::FitAllRows);
  connect(model, &QAbstractItemModel::rowsInserted, this,
          [this](const QModelIndex&, int first, int last) { FitRows(first, last); });
  connect(model, &QAbstractItemModel::dataChanged, this,
          [this](const QModelIndex& first, const QModelIndex& last) {
            if (first.column() <= name_column_ && name_column_ <= last.column())
              FitRows(first.row(), last.row());
          });
}

void Listing::FitAllRows() { FitRows(0, model()->rowCount() - 1); }

// A name's lines alone say how high a row is: the other columns have the room that they need.
void Listing::FitRows(int first, int last) {
  QStyleOptionViewItem option;
  initViewItemOption(&option);
  option.rect = QRect(0, 0, columnWidth(name_column_), 1);
  for (int row = first; row <= last; ++row) {
    const QModelIndex name = model()->index(row, name_column_);
    const int needed_px = itemDelegateForIndex(name)->sizeHint(option, name).height();
    setRowHeight(row, std::max(verticalHeader()->defaultSectionSize(), needed_px + kAroundTextPx));
  }
}

void Listing::paintEvent(QPaintEvent* event) {
  QTableView::paintEvent(event);
  if (model()->rowCount() > 0) return;
  QPainter painter(viewport());
  painter.setPen(ThemeColors().quiet_text);
  painter.drawText(viewport()->rect(), Qt::AlignCenter, empty_text_);
}

}  // namespace elbowroom::console
