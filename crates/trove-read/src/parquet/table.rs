//! A file as a table.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use trove_files::open_regular;

use super::fault::Fault;
use super::metadata::{ColumnInfo, Metadata};
use super::pages::{Page, Pages};
use super::values::{Physical, Sink};
use crate::ReadError;
use trove_files::Budget;

/// What a file begins and ends with.
const MAGIC: &[u8; 4] = b"PAR1";
/// Longer footers are damaged, bytes.
const LONGEST_FOOTER: u64 = 64 << 20;

/// An opened file.
pub(crate) struct Table {
    path: PathBuf,
    file: File,
    budget: Budget,
    metadata: Metadata,
}

impl Table {
    /// Reads a file's footer.
    ///
    /// # Errors
    /// A file that cannot be read or is no Parquet.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        let open = || {
            let file = open_regular(path)?;
            let length = file.metadata()?.len();
            let budget = Budget::of_file(length);
            let metadata = Metadata::read(&footer(&file, length)?, length, &budget)?;
            Ok(Self { path: path.to_owned(), file, budget, metadata })
        };
        open().map_err(|fault: Fault| fault.at(path, "footer"))
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// How many rows the file says that it has.
    pub(crate) fn rows(&self) -> u64 {
        self.metadata.rows
    }

    /// How the values of a column are written; `None` where there is no such column.
    pub(crate) fn kind(&self, column: &str) -> Option<Physical> {
        self.find(column).map(|info| info.kind)
    }

    /// A column row by row.
    ///
    /// # Errors
    /// No column of that name.
    pub(crate) fn column(&self, name: &str) -> Result<Rows<'_>, ReadError> {
        let info = self.find(name).ok_or_else(|| {
            let mut others: Vec<_> = self.metadata.columns.iter().map(|info| info.name.as_str()).collect();
            others.sort_by_key(|other| strsim::damerau_levenshtein(other, name));
            others.truncate(3);
            let found =
                if others.is_empty() { "none".to_owned() } else { format!("others, such as {}", others.join(", ")) };
            Fault::new("such a column", found).at(&self.path, format!("column '{name}'"))
        })?;
        let pages = Pages::new(&self.file, &self.budget, info);
        Ok(Rows { table: self, info, pages, page: None, row: 0 })
    }

    /// A column of one integer a row; `None` where there is none.
    ///
    /// # Errors
    /// No such column, one of another type, or damaged pages.
    pub(crate) fn integers(&self, name: &str) -> Result<Vec<Option<i64>>, ReadError> {
        let mut values = Vec::new();
        self.scalars(name, |rows| {
            Ok(rows.read(&mut Sink::Integers(&mut values))?.then(|| values.drain(..).next_back()))
        })
    }

    /// A column of one number a row; `None` where there is none.
    ///
    /// # Errors
    /// As [`Table::integers`].
    pub(crate) fn numbers(&self, name: &str) -> Result<Vec<Option<f64>>, ReadError> {
        let mut values = Vec::new();
        self.scalars(name, |rows| Ok(rows.read(&mut Sink::Numbers(&mut values))?.then(|| values.drain(..).next_back())))
    }

    /// A column of one text a row; `None` where there is none.
    ///
    /// # Errors
    /// As [`Table::integers`].
    pub(crate) fn texts(&self, name: &str) -> Result<Vec<Option<String>>, ReadError> {
        let mut values: Vec<Vec<u8>> = Vec::new();
        self.scalars(name, |rows| {
            let is_row = rows.read(&mut Sink::Texts(&mut values))?;
            Ok(is_row.then(|| values.drain(..).next_back().map(|text| String::from_utf8_lossy(&text).into_owned())))
        })
    }

    /// A column of lists of `N` numbers; `None` where a list has another length.
    ///
    /// # Errors
    /// As [`Table::integers`].
    pub(crate) fn arrays<const N: usize>(&self, name: &str) -> Result<Vec<Option<[f64; N]>>, ReadError> {
        let mut values = Vec::new();
        self.scalars(name, |rows| {
            values.clear();
            let is_row = rows.read(&mut Sink::Numbers(&mut values))?;
            Ok(is_row.then(|| values.as_slice().try_into().ok()))
        })
    }

    fn scalars<T>(
        &self,
        name: &str,
        mut read: impl FnMut(&mut Rows) -> Result<Option<Option<T>>, ReadError>,
    ) -> Result<Vec<Option<T>>, ReadError> {
        let (mut rows, mut column) = (self.column(name)?, Vec::new());
        while let Some(value) = read(&mut rows)? {
            self.budget.take(1, size_of::<Option<T>>()).map_err(|exceeded| rows.error(exceeded.into()))?;
            column.push(value);
        }
        Ok(column)
    }

    fn find(&self, column: &str) -> Option<&ColumnInfo> {
        self.metadata.columns.iter().find(|info| info.name == column)
    }
}

/// A column, row by row.
pub(crate) struct Rows<'a> {
    table: &'a Table,
    info: &'a ColumnInfo,
    pages: Pages<'a>,
    page: Option<Page>,
    row: u64,
}

impl Rows<'_> {
    /// Puts the values of the next row somewhere, none where there are none; false behind the last row.
    ///
    /// # Errors
    /// Values of another type, or damaged pages.
    pub(crate) fn read(&mut self, sink: &mut Sink) -> Result<bool, ReadError> {
        if !sink.takes(self.info.kind) {
            return Err(self.error(Fault::new(sink.wants(), format!("{:?}", self.info.kind))));
        }
        self.row_into(sink).map_err(|fault| self.error(fault))
    }

    fn row_into(&mut self, sink: &mut Sink) -> Result<bool, Fault> {
        let mut is_begun = false;
        loop {
            if self.page.as_ref().is_none_or(|page| page.left == 0) {
                self.page = self.pages.next()?;
            }
            let Some(page) = &mut self.page else {
                self.row += u64::from(is_begun);
                return Ok(is_begun);
            };
            if page.left == 0 {
                continue;
            }
            let (repeated, alike) = page.repeated.peek(page.left)?;
            if repeated == 0 && is_begun {
                self.row += 1;
                return Ok(true);
            }
            // A row begins with one value; more of its list may follow.
            let (defined, count) = page.defined.peek(if repeated == 0 { 1 } else { alike })?;
            page.repeated.pass(count);
            page.defined.pass(count);
            page.left -= count;
            if defined == self.info.most_defined {
                page.values.take(count, sink, &self.table.budget)?;
            }
            is_begun = true;
        }
    }

    fn error(&self, fault: Fault) -> ReadError {
        fault.at(&self.table.path, format!("column '{}', row {}", self.info.name, self.row))
    }
}

/// The footer's bytes.
fn footer(mut file: &File, length: u64) -> Result<Vec<u8>, Fault> {
    let none = || Fault::new("a Parquet file, which begins and ends with PAR1", "another or a truncated one");
    let (mut head, mut tail) = ([0; 4], [0; 8]);
    if length < 12 {
        return Err(none());
    }
    file.read_exact(&mut head)?;
    file.seek(SeekFrom::Start(length - 8))?;
    file.read_exact(&mut tail)?;
    let [a, b, c, d, end @ ..] = tail;
    let size = u64::from(u32::from_le_bytes([a, b, c, d]));
    if &head != MAGIC || &end != MAGIC {
        return Err(none());
    }
    if size > LONGEST_FOOTER.min(length - 12) {
        return Err(Fault::new("a footer within the file", format!("{size} bytes")));
    }
    file.seek(SeekFrom::Start(length - 8 - size))?;
    let mut bytes = Vec::new();
    file.take(size).read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[ignore = "needs TROVE_TEST_DATA"]
    fn real_keypoints_of_waymo_are_what_pyarrow_reads() {
        let data = PathBuf::from(std::env::var_os("TROVE_TEST_DATA").expect("TROVE_TEST_DATA"));
        let file = "waymo/v2/camera_hkp/10023947602400723454_1120_000_1140_000.parquet";
        let table = Table::open(&data.join(file)).unwrap();
        assert_eq!(table.rows(), 15_844);
        let names = table.texts("key.camera_name").unwrap();
        let count = |name: &str| names.iter().flatten().filter(|n| *n == name).count();
        assert_eq!((count("FRONT"), count("SIDE_RIGHT"), names.len()), (8364, 364, 15_844));
        let times = table.integers("key.frame_timestamp_micros").unwrap();
        assert_eq!(times.iter().flatten().map(|t| i128::from(*t)).sum::<i128>() % 1_000_000_000_000, 622_686_114_269);
        let lists = |name: &str| {
            let mut rows =
                table.column(&format!("[CameraHumanKeypointsComponent].camera_keypoints[*].{name}")).unwrap();
            let (mut integers, mut numbers, mut count) = (Vec::new(), Vec::new(), 0);
            let is_integer = rows.info.kind != Physical::Float;
            while rows
                .read(&mut if is_integer { Sink::Integers(&mut integers) } else { Sink::Numbers(&mut numbers) })
                .unwrap()
            {
                count += 1;
            }
            let sum = if is_integer { integers.iter().sum::<i64>() as f64 } else { numbers.iter().sum() };
            (count, integers.len() + numbers.len(), sum)
        };
        assert_eq!(lists("type"), (15_844, 5291, 60_496.0));
        assert_eq!(lists("keypoint_2d.visibility.is_occluded"), (15_844, 5291, 344.0));
        let (rows, values, sum) = lists("keypoint_2d.location_px.x");
        assert!((rows, values) == (15_844, 5291) && (sum - 4_474_688.515_414).abs() < 1e-3, "{sum}");
        assert_eq!(lists("keypoint_3d.location_m.x"), (15_844, 0, 0.0));
    }
}
