//! A file's footer: its columns and where their pages are.

use super::codec::Codec;
use super::fault::Fault;
use super::thrift::Thrift;
use super::values::Physical;
use trove_files::Budget;

/// Schemas of flat tables and lists are three deep.
const DEEPEST: usize = 8;

/// What a file holds.
pub(super) struct Metadata {
    pub(super) rows: u64,
    pub(super) columns: Vec<ColumnInfo>,
}

/// A column that can be read.
pub(super) struct ColumnInfo {
    pub(super) name: String,
    pub(super) kind: Physical,
    /// Levels of a value that is there, and of another element of the same list.
    pub(super) most_defined: u32,
    pub(super) most_repeated: u32,
    pub(super) chunks: Vec<Chunk>,
}

/// Where a part of a column's pages is.
#[derive(Clone, Copy)]
pub(super) struct Chunk {
    pub(super) codec: Codec,
    pub(super) from: u64,
    pub(super) to: u64,
    pub(super) values: u64,
}

/// A leaf of the schema, in the order of the chunks.
struct Leaf {
    name: String,
    kind: Option<Physical>,
    most_defined: u32,
    most_repeated: u32,
}

impl Metadata {
    /// From the footer's bytes of a file of so many bytes.
    pub(super) fn read(mut footer: &[u8], file_bytes: u64, budget: &Budget) -> Result<Self, Fault> {
        let file = Thrift::read(&mut footer, budget)?;
        let mut elements = file.list(2).iter();
        let root = elements.next().ok_or_else(|| Fault::new("a schema", "none"))?;
        let mut leaves = Vec::new();
        for _ in 0..root.integer(5).unwrap_or(0) {
            leaf(&mut elements, None, [0; 2], 0, &mut leaves)?;
        }
        let rows = count(file.integer(3), "a number of rows")?;
        let mut chunks: Vec<Vec<Chunk>> = leaves.iter().map(|_| Vec::new()).collect();
        for group in file.list(4) {
            let parts = group.list(1);
            if parts.len() != leaves.len() {
                let expected = format!("a row group of {} columns", leaves.len());
                return Err(Fault::new(expected, format!("{} columns", parts.len())));
            }
            for ((leaf, part), chunks) in leaves.iter().zip(parts).zip(&mut chunks) {
                // What is no column of ours may be packed in any way.
                if leaf.kind.is_some() {
                    chunks.push(chunk(part, file_bytes).map_err(|fault| named(fault, &leaf.name))?);
                }
            }
        }
        let column = |(leaf, chunks): (Leaf, Vec<Chunk>)| {
            let Leaf { name, kind, most_defined, most_repeated } = leaf;
            Some(ColumnInfo { name, kind: kind?, most_defined, most_repeated, chunks })
        };
        Ok(Self { rows, columns: leaves.into_iter().zip(chunks).filter_map(column).collect() })
    }
}

/// Walks one element of the schema and what is below it.
fn leaf<'e, 'a: 'e>(
    elements: &mut impl Iterator<Item = &'e Thrift<'a>>,
    column: Option<&str>,
    [defined, repeated]: [u32; 2],
    depth: usize,
    leaves: &mut Vec<Leaf>,
) -> Result<(), Fault> {
    let element = elements.next().ok_or_else(|| Fault::new("more of the schema", "its end"))?;
    let levels = match element.integer(3).unwrap_or(0) {
        0 => [defined, repeated],
        1 => [defined + 1, repeated],
        _ => [defined + 1, repeated + 1],
    };
    // A list's elements belong to the column that the list is called by.
    let column = column.or(element.text(4)).unwrap_or_default();
    let children = element.integer(5).unwrap_or(0);
    if children == 0 {
        // Lists of lists, and what else no table here has, are passed over.
        let kind = element.integer(1).and_then(Physical::of).filter(|_| levels[1] <= 1);
        leaves.push(Leaf { name: column.to_owned(), kind, most_defined: levels[0], most_repeated: levels[1] });
    }
    if depth > DEEPEST {
        return Err(Fault::new("a schema of lists at most", "a deeper one"));
    }
    for _ in 0..children {
        leaf(elements, Some(column), levels, depth + 1, leaves)?;
    }
    Ok(())
}

fn chunk(part: &Thrift, file_bytes: u64) -> Result<Chunk, Fault> {
    let about = part.field(3).ok_or_else(|| Fault::new("where a column's pages are", "nothing"))?;
    // A dictionary comes before the pages that refer to it.
    let pages = count(about.integer(9), "an offset of pages")?;
    let from = about.integer(11).and_then(|at| u64::try_from(at).ok()).filter(|at| *at > 0 && *at < pages);
    let (from, length) = (from.unwrap_or(pages), count(about.integer(7), "a length of pages")?);
    let to = from.checked_add(length).filter(|to| *to <= file_bytes);
    let to =
        to.ok_or_else(|| Fault::new(format!("pages within {file_bytes} bytes"), format!("{length} from {from} on")))?;
    let values = count(about.integer(5), "a number of values")?;
    Ok(Chunk { codec: Codec::of(about.integer(4).unwrap_or(0))?, from, to, values })
}

fn count(number: Option<i64>, what: &str) -> Result<u64, Fault> {
    number.and_then(|n| u64::try_from(n).ok()).ok_or_else(|| Fault::new(what, format!("{number:?}")))
}

fn named(fault: Fault, column: &str) -> Fault {
    match fault {
        Fault::Format { expected, found } => Fault::new(format!("{expected} in column '{column}'"), found),
        io => io,
    }
}
