#include "app/console/view/listing.h"

#include <QHeaderView>
#include <QPainter>
#include <utility>

#include "app/console/desktop/theme.h"

namespace elbowroom::console {

Listing::Listing(QAbstractItemModel* model, QString empty_text, QWidget* parent)
    : QTableView(parent), empty_text_(std::move(empty_text)) {
  setModel(model);
  setFocusPolicy(Qt::NoFocus);
  setSelectionMode(QAbstractItemView::NoSelection);
  setEditTriggers(QAbstractItemView::NoEditTriggers);
  setWordWrap(false);
  setShowGrid(false);
  verticalHeader()->hide();
  verticalHeader()->setDefaultSectionSize(fontMetrics().height() + 8);
  horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  horizontalHeader()->setSectionResizeMode(0, QHeaderView::Stretch);
  horizontalHeader()->setHighlightSections(false);
}

void Listing::paintEvent(QPaintEvent* event) {
  QTableView::paintEvent(event);
  if (model()->rowCount() > 0) return;
  QPainter painter(viewport());
  painter.setPen(ThemeColors().quiet_text);
  painter.drawText(viewport()->rect(), Qt::AlignCenter, empty_text_);
}

}  // namespace elbowroom::console
