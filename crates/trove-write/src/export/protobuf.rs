//! Messages of `foxglove.tsv` as protobuf, and the descriptors that tell readers what is in them.

use std::sync::LazyLock;

const TABLE: &str = include_str!("foxglove.tsv");

/// A field of a message.
struct Field {
    message: &'static str,
    name: &'static str,
    number: u32,
    /// A type of protobuf's, or a message's or an enum's name.
    kind: &'static str,
    /// Names of an enum's values, from 0.
    values: Vec<&'static str>,
    is_list: bool,
}

static FIELDS: LazyLock<Vec<Field>> = LazyLock::new(|| {
    let field = |line: &'static str| {
        let &[message, name, number, kind] = line.split('\t').collect::<Vec<_>>().as_slice() else {
            panic!("foxglove.tsv: expected four columns, found {line:?}")
        };
        let number = number.parse().unwrap_or_else(|_| panic!("foxglove.tsv: no number in {line:?}"));
        let (kind, is_list) = kind.strip_suffix("[]").map_or((kind, false), |kind| (kind, true));
        let (kind, values) = kind.split_once('{').map_or((kind, ""), |(kind, rest)| (kind, rest.trim_end_matches('}')));
        let values = values.split(',').filter(|value| !value.is_empty()).collect();
        Field { message, name, number, kind, values, is_list }
    };
    TABLE.lines().skip(1).map(field).collect()
});

/// Types of protobuf's: name, number in a descriptor.
const SCALARS: [(&str, u64); 6] =
    [("double", 1), ("int64", 3), ("int32", 5), ("fixed32", 7), ("string", 9), ("bytes", 12)];
const MESSAGE: u64 = 11;
const ENUM: u64 = 14;

const VARINT: u32 = 0;
const FIXED_64: u32 = 1;
const LENGTH: u32 = 2;
const FIXED_32: u32 = 5;

/// A message under way: fields are given by name, in any order.
pub(crate) struct Message {
    name: &'static str,
    bytes: Vec<u8>,
}

impl Message {
    /// An empty message of a type in the table.
    pub(crate) fn new(name: &'static str) -> Self {
        Self { name, bytes: Vec::new() }
    }

    /// Text.
    pub(crate) fn text(self, field: &str, value: &str) -> Self {
        self.length(field, &["string"], value.as_bytes())
    }

    /// Bytes.
    pub(crate) fn data(self, field: &str, value: &[u8]) -> Self {
        self.length(field, &["bytes"], value)
    }

    /// A number with a fraction.
    pub(crate) fn double(mut self, field: &str, value: f64) -> Self {
        self.tag(field, &["double"], FIXED_64);
        self.bytes.extend(value.to_le_bytes());
        self
    }

    /// Several numbers with fractions.
    pub(crate) fn doubles(self, field: &str, values: &[f64]) -> Self {
        let packed: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.length(field, &["double"], &packed)
    }

    /// A size.
    pub(crate) fn size(mut self, field: &str, value: u32) -> Self {
        self.tag(field, &["fixed32"], FIXED_32);
        self.bytes.extend(value.to_le_bytes());
        self
    }

    /// A whole number.
    pub(crate) fn integer(mut self, field: &str, value: i64) -> Self {
        self.tag(field, &["int64", "int32"], VARINT);
        varint(value as u64, &mut self.bytes);
        self
    }

    /// A value of an enum.
    pub(crate) fn choice(mut self, field: &str, value: &str) -> Self {
        let row = self.row(field);
        let number = row.values.iter().position(|name| *name == value);
        let number = number.unwrap_or_else(|| panic!("foxglove.tsv: {}.{field} has no {value}", self.name));
        self.tag(field, &[row.kind], VARINT);
        varint(number as u64, &mut self.bytes);
        self
    }

    /// A message, or one more of a list.
    pub(crate) fn message(self, field: &str, value: &Message) -> Self {
        self.length(field, &[value.name], &value.bytes)
    }

    /// Its bytes.
    pub(crate) fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    fn length(mut self, field: &str, kinds: &[&str], value: &[u8]) -> Self {
        self.tag(field, kinds, LENGTH);
        varint(value.len() as u64, &mut self.bytes);
        self.bytes.extend(value);
        self
    }

    fn row(&self, field: &str) -> &'static Field {
        let row = FIELDS.iter().find(|row| row.message == self.name && row.name == field);
        row.unwrap_or_else(|| panic!("foxglove.tsv: {} has no {field}", self.name))
    }

    fn tag(&mut self, field: &str, kinds: &[&str], wire: u32) {
        let row = self.row(field);
        assert!(kinds.contains(&row.kind), "foxglove.tsv: {}.{field} is {}", self.name, row.kind);
        varint(u64::from(row.number << 3 | wire), &mut self.bytes);
    }
}

/// A `FileDescriptorSet` of all messages in the table.
pub(crate) fn descriptors() -> Vec<u8> {
    let package = |package: &str, dependency: Option<&str>| {
        let mut file = field(1, format!("{}.proto", package.replace('.', "/")).as_bytes());
        file.extend(field(2, package.as_bytes()));
        if let Some(dependency) = dependency {
            file.extend(field(3, dependency.as_bytes()));
        }
        let mut names: Vec<&str> = FIELDS.iter().map(|row| row.message).collect();
        names.dedup();
        for name in names {
            if let Some(short) = name.strip_prefix(package).and_then(|rest| rest.strip_prefix('.')) {
                file.extend(field(4, &message_descriptor(name, short)));
            }
        }
        file.extend(field(12, b"proto3"));
        field(1, &file)
    };
    let [times, foxglove] = ["google.protobuf", "foxglove"];
    [package(times, None), package(foxglove, Some("google/protobuf.proto"))].concat()
}

fn message_descriptor(name: &str, short: &str) -> Vec<u8> {
    let mut message = field(1, short.as_bytes());
    for row in FIELDS.iter().filter(|row| row.message == name) {
        let mut descriptor = field(1, row.name.as_bytes());
        number(3, u64::from(row.number), &mut descriptor);
        number(4, if row.is_list { 3 } else { 1 }, &mut descriptor);
        let scalar = SCALARS.iter().find(|(kind, _)| *kind == row.kind).map(|(_, number)| *number);
        number(5, scalar.unwrap_or(if row.values.is_empty() { MESSAGE } else { ENUM }), &mut descriptor);
        if scalar.is_none() {
            descriptor.extend(field(6, format!(".{}", row.kind).as_bytes()));
        }
        message.extend(field(2, &descriptor));
        if !row.values.is_empty() {
            let mut kind = field(1, row.kind.rsplit('.').next().unwrap_or_default().as_bytes());
            for (value, name) in (0..).zip(&row.values) {
                let mut descriptor = field(1, name.as_bytes());
                number(2, value, &mut descriptor);
                kind.extend(field(2, &descriptor));
            }
            message.extend(field(4, &kind));
        }
    }
    message
}

fn field(number: u32, content: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    varint(u64::from(number << 3 | LENGTH), &mut bytes);
    varint(content.len() as u64, &mut bytes);
    bytes.extend(content);
    bytes
}

fn number(field: u32, value: u64, bytes: &mut Vec<u8>) {
    varint(u64::from(field << 3 | VARINT), bytes);
    varint(value, bytes);
}

fn varint(mut value: u64, bytes: &mut Vec<u8>) {
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_written_as_protobuf_writes_them() {
        let time = Message::new("google.protobuf.Timestamp").integer("seconds", 300).integer("nanos", 5);
        assert_eq!(time.into_bytes(), [0x08, 0xac, 0x02, 0x10, 0x05]);
        let point = Message::new("foxglove.Point2").double("x", 1.0);
        assert_eq!(point.into_bytes(), [0x09, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f]);
        let pair = Message::new("foxglove.KeyValuePair").text("key", "k");
        let entity = Message::new("foxglove.SceneEntity").message("metadata", &pair);
        assert_eq!(entity.into_bytes(), [0x32, 0x03, 0x0a, 0x01, b'k']);
        let deletion = Message::new("foxglove.SceneEntityDeletion").choice("type", "ALL");
        assert_eq!(deletion.into_bytes(), [0x10, 0x01]);
    }

    #[test]
    fn every_type_that_a_field_has_is_in_the_table() {
        for row in FIELDS.iter().filter(|row| row.values.is_empty()) {
            let is_scalar = SCALARS.iter().any(|(kind, _)| *kind == row.kind);
            assert!(is_scalar || FIELDS.iter().any(|other| other.message == row.kind), "{}", row.kind);
        }
    }
}
