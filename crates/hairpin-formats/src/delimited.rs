//! Delimited text as rows of cells: what all readers of such tables have in common.
//!
//! Rows know their lines, whatever blank lines and comments stand between them; a byte order mark, any line ends,
//! quoted cells and blanks around cells are understood. How many cells a row must have is for who reads it.

use csv::{Position, ReaderBuilder, StringRecord, StringRecordsIntoIter};

/// What a text may begin with that says nothing but how it is encoded.
pub(crate) const BYTE_ORDER_MARK: char = '\u{feff}';

/// How a text is cut into rows and cells.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cut {
    /// Between cells.
    pub(crate) delimiter: u8,
    /// What lines begin with that say nothing.
    pub(crate) comment: Option<u8>,
}

impl Cut {
    /// At commas.
    pub(crate) const COMMAS: Self = Self { delimiter: b',', comment: None };

    /// At what stands between the names of columns in the first line of `text` that is not blank: commas, or where it
    /// has none semicolons or tabs.
    pub(crate) fn told_by(text: &str) -> Self {
        let first = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
        Self { delimiter: delimiter_of(first.as_bytes()), ..Self::COMMAS }
    }
}

/// What stands between the names of columns in `head`.
pub(crate) fn delimiter_of(head: &[u8]) -> u8 {
    [b',', b';', b'\t'].into_iter().find(|delimiter| head.contains(delimiter)).unwrap_or(b',')
}

/// A text with names of columns in its first line.
pub(crate) struct Table<'t> {
    /// The first line.
    pub(crate) header: &'t str,
    /// Its cells.
    pub(crate) names: Row,
    /// What follows.
    pub(crate) rows: Rows<'t>,
}

impl<'t> Table<'t> {
    pub(crate) fn of(text: &'t str, cut: Cut) -> Self {
        let text = text.trim_start_matches(BYTE_ORDER_MARK);
        let mut rows = Rows::of(text, cut);
        let header = text.lines().next().unwrap_or_default();
        // A table without a first line has one name, and that is empty.
        let names = if header.trim().is_empty() { None } else { rows.next() };
        let names = names.unwrap_or(Row { line: 1, cells: StringRecord::from(vec![""]) });
        Self { header, names, rows }
    }
}

/// The rows of a text that are not blank.
pub(crate) struct Rows<'t> {
    bytes: &'t [u8],
    comment: Option<u8>,
    records: StringRecordsIntoIter<&'t [u8]>,
}

/// Cells in a line.
#[derive(Debug, Clone)]
pub(crate) struct Row {
    /// From 1.
    pub(crate) line: usize,
    cells: StringRecord,
}

impl<'t> Rows<'t> {
    pub(crate) fn of(text: &'t str, Cut { delimiter, comment }: Cut) -> Self {
        let bytes = text.trim_start_matches(BYTE_ORDER_MARK).as_bytes();
        let mut reader = ReaderBuilder::new();
        reader.has_headers(false).flexible(true).delimiter(delimiter).comment(comment);
        Self { bytes, comment, records: reader.from_reader(bytes).into_records() }
    }
}

/// The line, from 1, in which a record begins that the reader began to look for at `from`: blank lines and comments
/// before it are not told there.
pub(crate) fn line_of(bytes: &[u8], comment: Option<u8>, from: &Position) -> usize {
    let (mut at, mut line) = (from.byte() as usize, from.line() as usize);
    loop {
        match bytes.get(at) {
            Some(b'\r') => at += 1,
            Some(b'\n') => (at, line) = (at + 1, line + 1),
            Some(byte) if Some(*byte) == comment => {
                at += bytes[at..].iter().take_while(|byte| **byte != b'\n').count();
            }
            _ => return line,
        }
    }
}

impl Iterator for Rows<'_> {
    type Item = Row;

    fn next(&mut self) -> Option<Row> {
        loop {
            let cells = self.records.next()?.expect("text in memory, its rows of any width, can be read");
            let line = cells.position().map_or(0, |from| line_of(self.bytes, self.comment, from));
            let row = Row { line, cells };
            if row.len() > 1 || !row.cell(0).is_empty() {
                return Some(row);
            }
        }
    }
}

impl Row {
    /// Number of cells.
    pub(crate) fn len(&self) -> usize {
        self.cells.len()
    }

    /// A cell without the blanks around it; empty beyond the last one. Quotes behind a blank are none to the reader.
    pub(crate) fn cell(&self, place: usize) -> &str {
        self.cells.get(place).unwrap_or_default().trim().trim_matches('"').trim()
    }

    pub(crate) fn cells(&self) -> impl Iterator<Item = &str> {
        (0..self.len()).map(|place| self.cell(place))
    }

    /// Where the cell `name` is.
    pub(crate) fn place(&self, name: &str) -> Option<usize> {
        self.cells().position(|cell| cell == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str, cut: Cut) -> Vec<(usize, Vec<String>)> {
        Rows::of(text, cut).map(|row| (row.line, row.cells().map(str::to_owned).collect())).collect()
    }

    #[test]
    fn rows_know_their_lines_and_cells() {
        let owned = |line: usize, cells: &[&str]| (line, cells.iter().map(|cell| (*cell).to_owned()).collect());
        let text = "\u{feff}a, b ,\"c, d\"\r\n\r\n  \n1,,\n\n\n,,\n\"2\", \"3\"";
        let wanted =
            [owned(1, &["a", "b", "c, d"]), owned(4, &["1", "", ""]), owned(7, &["", "", ""]), owned(8, &["2", "3"])];
        assert_eq!(rows(text, Cut::COMMAS), wanted);
        let commented = Cut { comment: Some(b'#'), delimiter: b';' };
        assert_eq!(rows("# x\n\n# y\r\n1,5;2\n#\n3\n", commented), [owned(4, &["1,5", "2"]), owned(6, &["3"])]);
        assert!(rows("", Cut::COMMAS).is_empty());
    }

    #[test]
    fn names_of_columns_tell_what_stands_between_cells() {
        for (text, delimiter) in
            [("a,b;c", b','), ("\n \na;b\n1,2\n", b';'), ("a\tb;c\n", b';'), ("a\tb", b'\t'), ("", b',')]
        {
            assert_eq!(Cut::told_by(text).delimiter, delimiter, "{text:?}");
        }
    }

    #[test]
    fn tables_have_their_names_in_the_first_line() {
        let table = Table::of("x , y\n\n1,2\n", Cut::COMMAS);
        assert_eq!((table.header, table.names.place("y"), table.names.place("z")), ("x , y", Some(1), None));
        assert_eq!(table.rows.map(|row| row.line).collect::<Vec<_>>(), [3]);
        for blank in ["", "\n", " \nx,y\n"] {
            let table = Table::of(blank, Cut::COMMAS);
            assert_eq!((table.names.len(), table.names.cell(0)), (1, ""));
        }
    }
}
