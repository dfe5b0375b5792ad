//! `.osm.pbf`: OpenStreetMap in Protocol Buffers (<https://wiki.openstreetmap.org/wiki/PBF_Format>).

use std::borrow::Cow;
use std::io::{self, Read};

use flate2::read::ZlibDecoder;
use trove_model::{Outcome, Report};

use super::fault::Fault;
use super::raw::{LONGEST_WORDS, Raw, RawNode, RawRelation, RawWay, Tags};
use crate::protobuf::{Fields, Malformed, running_sums, zigzag};
use trove_files::{Budget, Exceeded};

/// The format's own limits, bytes.
const MAX_HEADER_BYTES: u32 = 64 << 10;
const MAX_BLOB_BYTES: u64 = 32 << 20;

/// Whether a file begins like this format's.
pub(super) fn is_pbf(head: &[u8]) -> bool {
    head.get(4..).is_some_and(|rest| rest.starts_with(b"\x0a\x09OSMHeader"))
}

/// Reads a whole file; a file that ends early is an error.
pub(super) fn parse(mut input: impl Read, budget: &Budget, report: &Report) -> Result<Raw, Fault> {
    let (mut raw, mut byte) = (Raw::default(), 0u64);
    loop {
        let mut length = [0; 4];
        match read_fully(&mut input, &mut length).map_err(Fault::Io)? {
            0 => return Ok(raw),
            4 => {}
            _ => return Err(cut_off().at(byte)),
        }
        let length = u32::from_be_bytes(length);
        if length > MAX_HEADER_BYTES {
            return Err(damaged("a blob's header of at most 64 KiB", format!("{length} bytes")).at(byte));
        }
        let header = read_exactly(&mut input, u64::from(length)).map_err(|e| e.at(byte))?;
        let (kind, size) =
            blob_header(&header).map_err(|_| damaged("a blob's header", "bytes that are not a message").at(byte))?;
        if size > MAX_BLOB_BYTES {
            return Err(damaged("a blob of at most 32 MiB", format!("{size} bytes")).at(byte));
        }
        let blob = read_exactly(&mut input, size).map_err(|e| e.at(byte))?;
        let read = match kind {
            b"OSMHeader" => unpacked(&blob).and_then(|data| check_features(&data)),
            b"OSMData" => unpacked(&blob).and_then(|data| Ok(add_block(&data, &mut raw, budget, report)?)),
            // Other kinds are to be skipped.
            _ => Ok(()),
        };
        read.map_err(|e| e.at(byte))?;
        byte += 4 + u64::from(length) + size;
    }
}

fn cut_off() -> Fault {
    Fault::new("a whole blob", "the end of the file", "the file is cut off: download it again")
}

fn damaged(expected: &str, found: impl Into<String>) -> Fault {
    Fault::new(expected, found, "the file is damaged: download it again")
}

/// Fills the buffer as far as the input goes.
fn read_fully(input: &mut impl Read, buffer: &mut [u8]) -> io::Result<usize> {
    let mut filled = 0;
    while filled < buffer.len() {
        match input.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(n) => filled += n,
            Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
            Err(e) => return Err(e),
        }
    }
    Ok(filled)
}

fn read_exactly(input: &mut impl Read, size: u64) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::new();
    input.take(size).read_to_end(&mut bytes).map_err(Fault::Io)?;
    if bytes.len() as u64 == size { Ok(bytes) } else { Err(cut_off()) }
}

fn blob_header(header: &[u8]) -> Result<(&[u8], u64), Malformed> {
    let (mut kind, mut size) = (&[][..], 0);
    for field in Fields::new(header) {
        match field? {
            (1, value) => kind = value.bytes()?,
            (3, value) => size = value.varint()?,
            _ => {}
        }
    }
    Ok((kind, size))
}

/// A blob's content, unpacked where it is packed.
fn unpacked(blob: &[u8]) -> Result<Vec<u8>, Fault> {
    for field in Fields::new(blob) {
        let malformed = |_| damaged("a blob", "bytes that are not a message");
        let (number, value) = field.map_err(malformed)?;
        match number {
            1 => return Ok(value.bytes().map_err(malformed)?.to_vec()),
            3 => {
                let mut data = Vec::new();
                let packed = ZlibDecoder::new(value.bytes().map_err(malformed)?);
                let unpacked = packed.take(MAX_BLOB_BYTES + 1).read_to_end(&mut data);
                unpacked.map_err(|e| damaged("data compressed with zlib", e.to_string()))?;
                if data.len() as u64 > MAX_BLOB_BYTES {
                    return Err(damaged("a blob of at most 32 MiB", "a longer one"));
                }
                return Ok(data);
            }
            2 => {}
            _ => {
                let remedy = "write it again with zlib: osmium cat in.osm.pbf -o out.osm.pbf -f pbf";
                return Err(Fault::new("data compressed with zlib or uncompressed", "another compression", remedy));
            }
        }
    }
    Err(damaged("a blob with data", "none"))
}

/// Refuses files that cannot be understood without more than is known here.
fn check_features(header: &[u8]) -> Result<(), Fault> {
    for field in Fields::new(header) {
        let malformed = |_| damaged("the file's header", "bytes that are not a message");
        if let (4, value) = field.map_err(malformed)? {
            let feature = value.bytes().map_err(malformed)?;
            if !matches!(feature, b"OsmSchema-V0.6" | b"DenseNodes") {
                let found = format!("one that needs {}", String::from_utf8_lossy(feature));
                return Err(Fault::new("an ordinary extract", found, "give one without history"));
            }
        }
    }
    Ok(())
}

/// Why a block cannot be read.
enum Unreadable {
    Malformed,
    TooLarge(Exceeded),
}

impl From<Malformed> for Unreadable {
    fn from(_: Malformed) -> Self {
        Self::Malformed
    }
}

impl From<Exceeded> for Unreadable {
    fn from(exceeded: Exceeded) -> Self {
        Self::TooLarge(exceeded)
    }
}

impl From<Unreadable> for Fault {
    fn from(unreadable: Unreadable) -> Self {
        match unreadable {
            Unreadable::Malformed => damaged("a block of nodes, ways and relations", "bytes that are not a message"),
            Unreadable::TooLarge(exceeded) => damaged(&exceeded.expected(), "more"),
        }
    }
}

/// What a block's elements refer to.
struct Block<'a> {
    /// Decoded once, however many elements refer to them; `None` for those that are too long to be words.
    strings: Vec<Option<Cow<'a, str>>>,
    budget: &'a Budget,
    granularity_nanodeg: i64,
    offset_nanodeg: [i64; 2],
}

impl Block<'_> {
    fn string(&self, index: u64) -> Result<Option<&str>, Malformed> {
        let string = usize::try_from(index).ok().and_then(|i| self.strings.get(i)).ok_or(Malformed)?;
        Ok(string.as_deref())
    }

    fn push(&self, tags: &mut Tags, key: u64, value: u64) -> Result<(), Unreadable> {
        if let (Some(key), Some(value)) = (self.string(key)?, self.string(value)?) {
            self.budget.take(1, tags.push(key, value))?;
        }
        Ok(())
    }

    fn tags(&self, keys: &[u64], values: &[u64]) -> Result<Tags, Unreadable> {
        let mut tags = Tags::default();
        keys.iter().zip(values).try_for_each(|(&key, &value)| self.push(&mut tags, key, value))?;
        Ok(tags)
    }

    fn node(&self, id: i64, lat: i64, lon: i64) -> RawNode {
        // Not in whole numbers: a damaged file's would overflow.
        let degrees = |n: i64, axis: usize| {
            1e-9 * (self.offset_nanodeg[axis] as f64 + self.granularity_nanodeg as f64 * n as f64)
        };
        RawNode { id, lat_deg: degrees(lat, 0), lon_deg: degrees(lon, 1) }
    }
}

fn add_block(data: &[u8], raw: &mut Raw, budget: &Budget, report: &Report) -> Result<(), Unreadable> {
    let mut block = Block { strings: Vec::new(), budget, granularity_nanodeg: 100, offset_nanodeg: [0; 2] };
    let mut groups = Vec::new();
    for field in Fields::new(data) {
        match field? {
            (1, value) => {
                for string in Fields::new(value.bytes()?) {
                    if let (1, value) = string? {
                        let bytes = value.bytes()?;
                        let word = (bytes.len() <= LONGEST_WORDS).then(|| String::from_utf8_lossy(bytes));
                        if word.is_none() {
                            let example = format!("{} bytes", bytes.len());
                            report.note(Outcome::Dropped, "osm: text longer than a tag may be", example);
                        }
                        block.strings.push(word);
                    }
                }
            }
            (2, value) => groups.push(value.bytes()?),
            (17, value) => block.granularity_nanodeg = value.varint()? as i64,
            (19, value) => block.offset_nanodeg[0] = value.varint()? as i64,
            (20, value) => block.offset_nanodeg[1] = value.varint()? as i64,
            _ => {}
        }
    }
    for group in groups {
        for field in Fields::new(group) {
            match field? {
                (1, value) => add_node(value.bytes()?, &block, raw, report)?,
                (2, value) => add_dense_nodes(value.bytes()?, &block, raw, report)?,
                (3, value) => raw.add_way(way(value.bytes()?, &block)?, report),
                (4, value) => raw.relations.push(relation(value.bytes()?, &block)?),
                _ => {}
            }
        }
    }
    Ok(())
}

/// An element's id, keys, values and its other repeated fields 8, 9 and 10.
#[derive(Default)]
struct Element {
    id: u64,
    keys: Vec<u64>,
    values: Vec<u64>,
    lists: [Vec<u64>; 3],
}

fn element(message: &[u8]) -> Result<Element, Malformed> {
    let mut element = Element::default();
    for field in Fields::new(message) {
        match field? {
            (1, value) => element.id = value.varint()?,
            (2, value) => value.append_to(&mut element.keys)?,
            (3, value) => value.append_to(&mut element.values)?,
            (number @ 8..=10, value) => value.append_to(&mut element.lists[number as usize - 8])?,
            _ => {}
        }
    }
    Ok(element)
}

fn add_node(message: &[u8], block: &Block, raw: &mut Raw, report: &Report) -> Result<(), Unreadable> {
    let element = element(message)?;
    let [lat, lon, _] = &element.lists;
    let (&[lat], &[lon]) = (lat.as_slice(), lon.as_slice()) else { return Err(Unreadable::Malformed) };
    block.budget.take(1, size_of::<RawNode>())?;
    let tags = block.tags(&element.keys, &element.values)?;
    raw.add_node(block.node(zigzag(element.id), zigzag(lat), zigzag(lon)), tags, report);
    Ok(())
}

fn way(message: &[u8], block: &Block) -> Result<RawWay, Unreadable> {
    let element = element(message)?;
    block.budget.take(1, size_of::<RawWay>() + size_of_val(element.lists[0].as_slice()))?;
    let tags = block.tags(&element.keys, &element.values)?;
    Ok(RawWay { id: element.id as i64, nodes: running_sums(&element.lists[0]).collect(), tags })
}

fn relation(message: &[u8], block: &Block) -> Result<RawRelation, Unreadable> {
    const NODE: u64 = 0;
    const WAY: u64 = 1;
    let element = element(message)?;
    block.budget.take(1, size_of::<RawRelation>() + size_of_val(element.lists[1].as_slice()))?;
    let tags = block.tags(&element.keys, &element.values)?;
    let members = |wanted: u64| {
        let all = running_sums(&element.lists[1]).zip(&element.lists[2]);
        all.filter(|(_, kind)| **kind == wanted).map(|(id, _)| id).collect()
    };
    Ok(RawRelation { id: element.id as i64, ways: members(WAY), nodes: members(NODE), tags })
}

fn add_dense_nodes(message: &[u8], block: &Block, raw: &mut Raw, report: &Report) -> Result<(), Unreadable> {
    let (mut ids, mut lats, mut lons, mut tags) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for field in Fields::new(message) {
        match field? {
            (1, value) => value.append_to(&mut ids)?,
            (8, value) => value.append_to(&mut lats)?,
            (9, value) => value.append_to(&mut lons)?,
            (10, value) => value.append_to(&mut tags)?,
            _ => {}
        }
    }
    if ids.len() != lats.len() || ids.len() != lons.len() {
        return Err(Unreadable::Malformed);
    }
    block.budget.take(ids.len(), size_of::<RawNode>())?;
    // Keys and values of all nodes in one list, a 0 after each node's.
    let mut tags = tags.split(|&string| string == 0);
    for ((id, lat), lon) in running_sums(&ids).zip(running_sums(&lats)).zip(running_sums(&lons)) {
        let mut of_node = Tags::default();
        for pair in tags.next().unwrap_or_default().chunks_exact(2) {
            block.push(&mut of_node, pair[0], pair[1])?;
        }
        raw.add_node(block.node(id, lat, lon), of_node, report);
    }
    Ok(())
}
