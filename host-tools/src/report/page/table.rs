//! Tables that sort: a cell has its text, and the number that it is sorted by.

use maud::{Markup, html};

/// A cell.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Cell {
    /// Words, sorted as such.
    Word(String),
    /// A number as text, and itself.
    Number(String, f64),
    /// Nothing: sorted last.
    Empty,
}

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    /// Its header.
    pub(super) title: String,
    /// What the header means.
    pub(super) hint: &'static str,
    /// A cell for each row.
    pub(super) cells: Vec<Cell>,
}

impl Column {
    fn is_empty(&self) -> bool {
        self.cells.iter().all(|cell| *cell == Cell::Empty)
    }

    fn is_numeric(&self) -> bool {
        !self.cells.iter().any(|cell| matches!(cell, Cell::Word(_)))
    }
}

/// A table with the name `id` for the script, whose rows have the report's indices. Columns without any value are left out.
pub(super) fn table(id: &str, columns: &[Column], rows: &[Option<usize>]) -> Markup {
    let columns: Vec<&Column> = columns.iter().filter(|column| !column.is_empty()).collect();
    html! {
        div.scroll { table.sortable id=(id) {
            thead { tr {
                @for column in &columns {
                    th scope="col" .number[column.is_numeric()] title=(column.hint) { (column.title) }
                }
            } }
            tbody { @for (index, row) in rows.iter().enumerate() {
                tr data-row=[row] { @for column in &columns { (cell(&column.cells[index])) } }
            } }
        } }
    }
}

fn cell(cell: &Cell) -> Markup {
    match cell {
        Cell::Word(text) => html! { td { (text) } },
        Cell::Number(text, value) => html! { td.number data-value=(value) { (text) } },
        Cell::Empty => html! { td.number { "–" } },
    }
}
