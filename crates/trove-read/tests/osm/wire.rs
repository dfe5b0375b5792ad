//! Protocol Buffers, as extracts are written in them.

/// The blob that begins every extract.
pub(crate) fn header() -> Vec<u8> {
    blob("OSMHeader", &[bytes(4, b"OsmSchema-V0.6"), bytes(4, b"DenseNodes")].concat())
}

/// A number of variable length.
pub(crate) fn varint(mut value: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
    bytes
}

/// A field that holds bytes: a string, or a message.
pub(crate) fn bytes(number: u64, content: &[u8]) -> Vec<u8> {
    [varint(number << 3 | 2), varint(content.len() as u64), content.to_vec()].concat()
}

/// A field of packed numbers.
pub(crate) fn packed(number: u64, values: &[u64]) -> Vec<u8> {
    bytes(number, &values.iter().flat_map(|&v| varint(v)).collect::<Vec<_>>())
}

/// A field of packed differences.
pub(crate) fn deltas(number: u64, values: &[i64]) -> Vec<u8> {
    let mut last = 0;
    let zigzag = |&v: &i64| {
        let delta = v - std::mem::replace(&mut last, v);
        (delta << 1 ^ delta >> 63) as u64
    };
    packed(number, &values.iter().map(zigzag).collect::<Vec<_>>())
}

/// A blob of a kind with its header, not compressed.
pub(crate) fn blob(kind: &str, content: &[u8]) -> Vec<u8> {
    let blob = bytes(1, content);
    let header = [bytes(1, kind.as_bytes()), varint(3 << 3), varint(blob.len() as u64)].concat();
    [(header.len() as u32).to_be_bytes().to_vec(), header, blob].concat()
}
