//! Writes Parquet as pyarrow does for flat tables and lists, without dictionaries.

use std::io::Write;

use super::waymo_writer::varint;

/// A column; lists may be missing.
#[derive(Clone)]
pub(crate) enum Column {
    Long(Vec<i64>),
    Int(Vec<i64>),
    Double(Vec<f64>),
    Text(Vec<String>),
    Bytes(Vec<Vec<u8>>),
    Doubles(Vec<Option<Vec<f64>>>),
    Floats(Vec<Option<Vec<f32>>>),
    Ints(Vec<Option<Vec<i64>>>),
}

/// Rows of a page at most: pages of range images stay as small as a reader expects.
const PAGE_ROWS: usize = 16;

/// How pages are packed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Packing {
    None,
    Snappy,
    Gzip,
    Zstd,
}

/// A column as it is written.
struct Written {
    kind: i64,
    is_list: bool,
    repeated: Vec<u8>,
    defined: Vec<u8>,
    values: Vec<u8>,
}

impl Column {
    fn rows(&self) -> usize {
        match self {
            Self::Long(rows) | Self::Int(rows) => rows.len(),
            Self::Double(rows) => rows.len(),
            Self::Text(rows) => rows.len(),
            Self::Bytes(rows) => rows.len(),
            Self::Doubles(rows) => rows.len(),
            Self::Floats(rows) => rows.len(),
            Self::Ints(rows) => rows.len(),
        }
    }

    /// The rows of the page that begins with one.
    fn page(&self, row: usize) -> Self {
        fn some<T: Clone>(rows: &[T], row: usize) -> Vec<T> {
            rows.iter().skip(row).take(PAGE_ROWS).cloned().collect()
        }
        match self {
            Self::Long(rows) => Self::Long(some(rows, row)),
            Self::Int(rows) => Self::Int(some(rows, row)),
            Self::Double(rows) => Self::Double(some(rows, row)),
            Self::Text(rows) => Self::Text(some(rows, row)),
            Self::Bytes(rows) => Self::Bytes(some(rows, row)),
            Self::Doubles(rows) => Self::Doubles(some(rows, row)),
            Self::Floats(rows) => Self::Floats(some(rows, row)),
            Self::Ints(rows) => Self::Ints(some(rows, row)),
        }
    }

    fn written(&self) -> Written {
        let flat = |kind, values| Written {
            kind,
            is_list: false,
            repeated: Vec::new(),
            defined: vec![1; self.rows()],
            values,
        };
        match self {
            Self::Long(rows) => flat(2, rows.iter().flat_map(|v| v.to_le_bytes()).collect()),
            Self::Int(rows) => flat(1, rows.iter().flat_map(|v| (*v as i32).to_le_bytes()).collect()),
            Self::Double(rows) => flat(5, rows.iter().flat_map(|v| v.to_le_bytes()).collect()),
            Self::Text(rows) => flat(6, rows.iter().flat_map(|text| after_its_length(text.as_bytes())).collect()),
            Self::Bytes(rows) => flat(6, rows.iter().flat_map(|bytes| after_its_length(bytes)).collect()),
            Self::Doubles(rows) => lists(5, rows, |v| v.to_le_bytes().to_vec()),
            Self::Floats(rows) => lists(4, rows, |v| v.to_le_bytes().to_vec()),
            Self::Ints(rows) => lists(1, rows, |v| (*v as i32).to_le_bytes().to_vec()),
        }
    }
}

fn after_its_length(bytes: &[u8]) -> Vec<u8> {
    [&(bytes.len() as u32).to_le_bytes()[..], bytes].concat()
}

fn lists<T>(kind: i64, rows: &[Option<Vec<T>>], bytes: impl Fn(&T) -> Vec<u8>) -> Written {
    let (mut repeated, mut defined, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for row in rows {
        match row.as_deref() {
            None => (repeated.push(0), defined.push(0)),
            Some([]) => (repeated.push(0), defined.push(1)),
            Some(list) => {
                repeated.push(0);
                repeated.extend(std::iter::repeat_n(1, list.len() - 1));
                defined.extend(std::iter::repeat_n(3, list.len()));
                values.extend(list.iter().flat_map(&bytes));
                ((), ())
            }
        };
    }
    Written { kind, is_list: true, repeated, defined, values }
}

/// A file of one row group.
pub(crate) fn parquet(columns: &[(&str, Column)], packing: Packing) -> Vec<u8> {
    let mut file = b"PAR1".to_vec();
    let rows = columns.first().map_or(0, |(_, column)| column.rows());
    let element = |name: &str, kind: Option<i64>, repetition: i64, children: i64| {
        let mut element = Thrift::default();
        if let Some(kind) = kind {
            element = element.int(1, kind);
        }
        element = element.int(3, repetition).bytes(4, name.as_bytes());
        if children > 0 { element.int(5, children) } else { element }
    };
    let mut schema = vec![element("schema", None, 0, columns.len() as i64)];
    let mut chunks = Vec::new();
    for (name, column) in columns {
        let pages: Vec<Written> =
            (0..column.rows().max(1)).step_by(PAGE_ROWS).map(|row| column.page(row).written()).collect();
        let (is_list, kind) = (pages[0].is_list, pages[0].kind);
        if is_list {
            schema.push(element(name, None, 1, 1));
            schema.push(element("list", None, 2, 1));
            schema.push(element("element", Some(kind), 1, 0));
        } else {
            schema.push(element(name, Some(kind), 1, 0));
        }
        let from = file.len() as i64;
        let (mut count, mut unpacked) = (0, 0);
        for written in pages {
            let mut page = Vec::new();
            if is_list {
                page.extend(levels(&written.repeated));
            }
            page.extend(levels(&written.defined));
            page.extend(&written.values);
            let (size, packed) = (page.len(), pack(&page, packing));
            let values = written.defined.len() as i64;
            let data = Thrift::default().int(1, values).int(2, 0).int(3, 3).int(4, 3);
            let head = Thrift::default().int(1, 0).int(2, size as i64).int(3, packed.len() as i64).structure(5, data);
            let head = head.end();
            file.extend(&head);
            file.extend(&packed);
            count += values;
            unpacked += (head.len() + size) as i64;
        }
        let codec = [Packing::None, Packing::Snappy, Packing::Gzip].iter().position(|p| *p == packing).unwrap_or(6);
        let about = Thrift::default()
            .int(1, kind)
            .int(4, codec as i64)
            .int(5, count)
            .int(6, unpacked)
            .int(7, file.len() as i64 - from)
            .int(9, from);
        chunks.push(Thrift::default().int(2, from).structure(3, about));
    }
    let group = Thrift::default().list(1, chunks).int(2, 0).int(3, rows as i64);
    let footer = Thrift::default().int(1, 2).list(2, schema).int(3, rows as i64).list(4, vec![group]).end();
    file.extend(&footer);
    file.extend((footer.len() as u32).to_le_bytes());
    file.extend(b"PAR1");
    file
}

/// Levels as runs of the same one, after their length.
fn levels(levels: &[u8]) -> Vec<u8> {
    let mut runs = Vec::new();
    for run in levels.chunk_by(|a, b| a == b) {
        varint(&mut runs, (run.len() as u64) << 1);
        runs.push(run[0]);
    }
    [&(runs.len() as u32).to_le_bytes()[..], &runs].concat()
}

fn pack(page: &[u8], packing: Packing) -> Vec<u8> {
    match packing {
        Packing::None => page.to_vec(),
        Packing::Snappy => {
            // Literals alone.
            let mut packed = Vec::new();
            varint(&mut packed, page.len() as u64);
            for literal in page.chunks(1 << 16) {
                packed.push(61 << 2);
                packed.extend(((literal.len() - 1) as u16).to_le_bytes());
                packed.extend(literal);
            }
            packed
        }
        Packing::Gzip => {
            let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
            packer.write_all(page).unwrap();
            packer.finish().unwrap()
        }
        Packing::Zstd => zstd::bulk::compress(page, 1).unwrap(),
    }
}

/// Thrift's compact protocol, every field with its whole number.
#[derive(Clone, Default)]
struct Thrift(Vec<u8>);

impl Thrift {
    fn field(mut self, number: u64, kind: u8) -> Self {
        self.0.push(kind);
        varint(&mut self.0, number << 1);
        self
    }

    fn int(self, number: u64, value: i64) -> Self {
        let mut thrift = self.field(number, 6);
        varint(&mut thrift.0, ((value << 1) ^ (value >> 63)) as u64);
        thrift
    }

    fn bytes(self, number: u64, value: &[u8]) -> Self {
        let mut thrift = self.field(number, 8);
        varint(&mut thrift.0, value.len() as u64);
        thrift.0.extend(value);
        thrift
    }

    fn structure(self, number: u64, value: Self) -> Self {
        let mut thrift = self.field(number, 12);
        thrift.0.extend(value.end());
        thrift
    }

    fn list(self, number: u64, structures: Vec<Self>) -> Self {
        let mut thrift = self.field(number, 9);
        thrift.0.push(0xfc);
        varint(&mut thrift.0, structures.len() as u64);
        thrift.0.extend(structures.into_iter().flat_map(Self::end));
        thrift
    }

    fn end(mut self) -> Vec<u8> {
        self.0.push(0);
        self.0
    }
}
