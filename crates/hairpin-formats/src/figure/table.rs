//! Rows under headers, as CSV and as words.

/// One cell.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A whole number.
    Count(u64),
    /// A number; not finite: none.
    Number(f64),
    /// Nothing.
    Empty,
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.into())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<usize> for Cell {
    fn from(count: usize) -> Self {
        Self::Count(count as u64)
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Empty, Into::into)
    }
}

impl Cell {
    /// All digits, for files.
    fn exact(&self) -> String {
        match self {
            Self::Text(text) if text.contains([',', '"', '\n', '\r']) => format!("\"{}\"", text.replace('"', "\"\"")),
            Self::Text(text) => text.clone(),
            Self::Count(count) => count.to_string(),
            Self::Number(number) if number.is_finite() => number.to_string(),
            Self::Number(_) | Self::Empty => String::new(),
        }
    }

    /// Three digits that count, for people.
    fn shown(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Count(count) => count.to_string(),
            Self::Number(number) if number.is_finite() => three_digits(*number),
            Self::Number(_) | Self::Empty => "–".into(),
        }
    }

    /// For machines.
    fn value(&self) -> serde_json::Value {
        match self {
            Self::Text(text) => text.as_str().into(),
            Self::Count(count) => (*count).into(),
            Self::Number(number) => (*number).into(),
            Self::Empty => serde_json::Value::Null,
        }
    }
}

/// `number` with three significant digits: 1230, 12.3, 0.00123, 1.23e-5.
pub(super) fn three_digits(number: f64) -> String {
    let size = number.abs();
    if number == 0.0 {
        "0".into()
    } else if size < 5e-4 {
        format!("{number:.2e}")
    } else {
        let digits = (2.0 - libm::floor(libm::log10(size))).max(0.0);
        format!("{number:.*}", digits as usize)
    }
}

/// Rows of cells under headers, the unit in each header's name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<Cell>>,
}

impl Table {
    /// Without rows.
    pub fn new(columns: &[&str]) -> Self {
        Self { columns: columns.iter().map(|name| (*name).into()).collect(), rows: Vec::new() }
    }

    /// One row more, with a cell for every column.
    pub fn push(&mut self, row: Vec<Cell>) {
        assert!(row.len() == self.columns.len(), "a cell for every column");
        self.rows.push(row);
    }

    /// As CSV, all digits.
    pub fn csv(&self) -> String {
        let mut text = self.columns.iter().map(|name| Cell::from(name.as_str()).exact()).collect::<Vec<_>>().join(",");
        text.push('\n');
        for row in &self.rows {
            text.push_str(&row.iter().map(Cell::exact).collect::<Vec<_>>().join(","));
            text.push('\n');
        }
        text
    }

    /// Header and rows for people, three digits a number.
    pub fn shown(&self) -> Vec<Vec<String>> {
        let rows = self.rows.iter().map(|row| row.iter().map(Cell::shown).collect());
        std::iter::once(self.columns.clone()).chain(rows).collect()
    }

    /// Rows as objects, for machines.
    pub fn objects(&self) -> serde_json::Value {
        let object = |row: &Vec<Cell>| -> serde_json::Map<String, serde_json::Value> {
            self.columns.iter().cloned().zip(row.iter().map(Cell::value)).collect()
        };
        self.rows.iter().map(object).collect()
    }
}
