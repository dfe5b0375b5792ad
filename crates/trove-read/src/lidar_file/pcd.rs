//! PCD 0.7 of the Point Cloud Library: `ascii`, `binary` and `binary_compressed`.

use glam::DVec3;

use super::bytes::{array, u32_at};
use super::lzf;
use trove_files::Budget;

/// A header has a dozen lines; what has not ended by then is none, bytes.
const LONGEST_HEADER: usize = 1 << 16;
/// No file has more fields a point, or more values in one.
const MOST_VALUES: usize = 4096;

/// One field of a point.
#[derive(Clone, Copy, Debug)]
struct Field {
    /// `F`, `I` or `U`.
    kind: u8,
    /// Bytes of a value.
    size: usize,
    /// Values.
    count: usize,
    /// Bytes of the fields before.
    start: usize,
    /// Values of the fields before.
    first: usize,
}

struct Header<'a> {
    xyz: [Field; 3],
    /// Bytes of a point.
    point_bytes: usize,
    /// Values of a point.
    values: usize,
    points: usize,
    data: &'a str,
}

pub(super) fn points(bytes: &[u8], budget: &Budget) -> Result<Vec<DVec3>, String> {
    let (header, body) = header(bytes)?;
    budget.take(header.points, size_of::<DVec3>()).map_err(|exceeded| format!("expected {}", exceeded.expected()))?;
    match header.data {
        "ascii" => ascii(&header, body),
        "binary" => binary(&header, body),
        "binary_compressed" => compressed(&header, body, budget),
        other => Err(format!("expected DATA ascii, binary or binary_compressed, found '{other}'")),
    }
}

/// The header and what follows it.
fn header(bytes: &[u8]) -> Result<(Header<'_>, &[u8]), String> {
    let (mut names, mut sizes, mut kinds, mut counts, mut points) = (vec![], vec![], vec![], None, None);
    let mut size = [None; 2];
    let mut rest = &bytes[..bytes.len().min(LONGEST_HEADER)];
    let (data, read) = loop {
        let end = rest.iter().position(|&b| b == b'\n').ok_or("expected a PCD header that ends with a line DATA")?;
        let line = std::str::from_utf8(&rest[..end]).map_err(|_| "expected a PCD header of plain text")?.trim();
        rest = &rest[end + 1..];
        let (word, values) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let numbers = || values.split_whitespace().map(|v| v.parse::<usize>().ok()).collect::<Option<Vec<_>>>();
        let numbers = || numbers().ok_or_else(|| format!("{word}: expected whole numbers, found '{values}'"));
        match word {
            "FIELDS" => names = values.split_whitespace().collect(),
            "SIZE" => sizes = numbers()?,
            "TYPE" => kinds = values.split_whitespace().map(|t| t.as_bytes()[0]).collect(),
            "COUNT" => counts = Some(numbers()?),
            "WIDTH" => size[0] = numbers()?.first().copied(),
            "HEIGHT" => size[1] = numbers()?.first().copied(),
            "POINTS" => points = numbers()?.first().copied(),
            "DATA" => break (values.trim(), bytes.len().min(LONGEST_HEADER) - rest.len()),
            _ => {} // comments, VERSION, VIEWPOINT
        }
    };
    let counts = counts.unwrap_or_else(|| vec![1; names.len()]);
    if names.is_empty() || [sizes.len(), kinds.len(), counts.len()] != [names.len(); 3] {
        let found = [names.len(), sizes.len(), kinds.len(), counts.len()];
        return Err(format!("expected as many FIELDS as SIZE, TYPE and COUNT, found {found:?}"));
    }
    let (mut start, mut first) = (0, 0);
    let mut fields = Vec::new();
    for ((&size, &kind), &count) in sizes.iter().zip(&kinds).zip(&counts) {
        if !matches!(size, 1 | 2 | 4 | 8)
            || !matches!(kind, b'F' | b'I' | b'U')
            || count > MOST_VALUES
            || first > MOST_VALUES
        {
            return Err(format!("expected SIZE 1, 2, 4 or 8, TYPE F, I or U and COUNT to {MOST_VALUES}, found others"));
        }
        fields.push(Field { kind, size, count, start, first });
        (start, first) = (start + size * count, first + count);
    }
    let field = |name: &str| {
        let at = names.iter().position(|n| *n == name).filter(|&i| fields[i].count > 0);
        at.map(|i| fields[i]).ok_or_else(|| format!("expected FIELDS with x, y and z, found {}", names.join(" ")))
    };
    let xyz = [field("x")?, field("y")?, field("z")?];
    let area = size[0].zip(size[1]).and_then(|(width, height)| width.checked_mul(height));
    let points = points.or(area).filter(|&n| n > 0).ok_or("expected POINTS of 1 or more")?;
    Ok((Header { xyz, point_bytes: start, values: first, points, data }, &bytes[read..]))
}

fn ascii(header: &Header, body: &[u8]) -> Result<Vec<DVec3>, String> {
    let text = std::str::from_utf8(body).map_err(|_| "expected numbers as text after DATA ascii")?;
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let mut points = Vec::new();
    for i in 0..header.points {
        let line = lines.next().ok_or_else(|| format!("expected {} points, found {i}", header.points))?;
        let values: Vec<&str> = line.split_whitespace().take(header.values + 1).collect();
        let value = |field: Field| values.get(field.first).and_then(|v| v.parse::<f64>().ok());
        match (value(header.xyz[0]), value(header.xyz[1]), value(header.xyz[2])) {
            (Some(x), Some(y), Some(z)) if values.len() == header.values => points.push(DVec3::new(x, y, z)),
            _ => return Err(format!("point {i}: expected {} numbers, found '{line:.60}'", header.values)),
        }
    }
    Ok(points)
}

/// A value as float64; NaN where it is of a type that no coordinate has.
fn value(field: Field, bytes: &[u8]) -> f64 {
    let number = match (field.kind, field.size) {
        (b'F', 4) => array(bytes, 0).map(|b| f64::from(f32::from_le_bytes(b))),
        (b'F', 8) => array(bytes, 0).map(f64::from_le_bytes),
        (b'I', 2) => array(bytes, 0).map(|b| f64::from(i16::from_le_bytes(b))),
        (b'I', 4) => array(bytes, 0).map(|b| f64::from(i32::from_le_bytes(b))),
        _ => None,
    };
    number.unwrap_or(f64::NAN)
}

fn binary(header: &Header, body: &[u8]) -> Result<Vec<DVec3>, String> {
    let length = header.points.checked_mul(header.point_bytes);
    let data = length.and_then(|length| body.get(..length));
    let data = data.ok_or_else(|| format!("expected {} points, found {} bytes", header.points, body.len()))?;
    let point = |point: &[u8]| DVec3::from_array(header.xyz.map(|field| value(field, &point[field.start..])));
    Ok(data.chunks_exact(header.point_bytes).map(point).collect())
}

/// Packed, all points' first field comes first.
fn compressed(header: &Header, body: &[u8], budget: &Budget) -> Result<Vec<DVec3>, String> {
    let sizes = u32_at(body, 0).zip(u32_at(body, 4)).map(|(packed, whole)| (packed as usize, whole as usize));
    let (packed, whole) = sizes.ok_or("expected the sizes of the packed points, found the end of the file")?;
    if header.points.checked_mul(header.point_bytes) != Some(whole) {
        return Err(format!("expected {} points of {} bytes, found {whole} bytes", header.points, header.point_bytes));
    }
    budget.take(whole, 1).map_err(|exceeded| format!("expected {}", exceeded.expected()))?;
    let data = packed.checked_add(8).and_then(|end| body.get(8..end));
    let data = data.and_then(|data| lzf::unpacked(data, whole)).ok_or("expected points packed by LZF, found damage")?;
    let point = |i: usize| {
        DVec3::from_array(header.xyz.map(|f| value(f, &data[f.start * header.points + i * f.size * f.count..])))
    };
    Ok((0..header.points).map(point).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [DVec3; 2] = [DVec3::new(1.5, -2.0, 0.25), DVec3::new(3.0, 4.0, 5.0)];

    fn file(data: &str, body: &[u8]) -> Vec<u8> {
        let header = format!(
            "# .PCD v0.7\nVERSION 0.7\nFIELDS intensity x y z\nSIZE 2 4 4 8\nTYPE U F F F\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\n\
             VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA {data}\n"
        );
        [header.as_bytes(), body].concat()
    }

    fn point(p: DVec3) -> Vec<u8> {
        [&7u16.to_le_bytes()[..], &(p.x as f32).to_le_bytes(), &(p.y as f32).to_le_bytes(), &p.z.to_le_bytes()].concat()
    }

    fn packed() -> Vec<u8> {
        let columns = [
            POINTS.iter().flat_map(|_| 7u16.to_le_bytes()).collect::<Vec<u8>>(),
            POINTS.iter().flat_map(|p| (p.x as f32).to_le_bytes()).collect(),
            POINTS.iter().flat_map(|p| (p.y as f32).to_le_bytes()).collect(),
            POINTS.iter().flat_map(|p| p.z.to_le_bytes()).collect(),
        ]
        .concat();
        // As they are, at most 32 bytes at a time.
        let data: Vec<u8> = columns.chunks(32).flat_map(|c| [&[c.len() as u8 - 1], c].concat()).collect();
        [&(data.len() as u32).to_le_bytes()[..], &(columns.len() as u32).to_le_bytes(), &data].concat()
    }

    fn read(bytes: &[u8]) -> Result<Vec<DVec3>, String> {
        points(bytes, &Budget::of_file(bytes.len() as u64))
    }

    #[test]
    fn all_three_kinds_of_data_give_the_same_points() {
        assert_eq!(read(&file("ascii", b"7 1.5 -2 0.25\n7 3 4 5\n")).unwrap(), POINTS);
        assert_eq!(read(&file("binary", &POINTS.map(point).concat())).unwrap(), POINTS);
        assert_eq!(read(&file("binary_compressed", &packed())).unwrap(), POINTS);
        assert!(read(&file("ascii", b"7 nan nan nan\n7 3 4 5\n")).unwrap()[0].is_nan());
    }

    #[test]
    fn what_is_no_pcd_says_why() {
        let check = |bytes: &[u8], expect: &str| {
            let error = read(bytes).unwrap_err();
            assert!(error.contains(expect), "{error}");
        };
        let changed = |from: &str, to: &str| {
            let text = String::from_utf8(file("ascii", b"7 1.5 -2 0.25\n7 3 4 5\n")).unwrap();
            text.replace(from, to).into_bytes()
        };
        check(b"", "ends with a line DATA");
        check(&file("zip", b""), "found 'zip'");
        check(&file("ascii", b"7 1 2 3\n"), "expected 2 points, found 1");
        check(&file("ascii", b"7 1 2 3\n7 1 2\n"), "point 1: expected 4 numbers");
        check(&file("binary", &point(POINTS[0])), "expected 2 points");
        check(&file("binary_compressed", &packed()[..20]), "LZF");
        check(&file("binary_compressed", &[]), "end of the file");
        check(&changed("FIELDS intensity x", "FIELDS intensity u"), "with x, y and z");
        check(&changed("SIZE 2 4 4 8", "SIZE 2 4 4"), "as many FIELDS");
        check(&changed("SIZE 2 4 4 8", "SIZE 2 4 4 9"), "expected SIZE 1, 2, 4 or 8");
        check(&changed("SIZE 2 4 4 8", "SIZE 2 4 -4 8"), "expected whole numbers");
        check(&changed("COUNT 1 1 1 1", "COUNT 1 0 1 1"), "with x, y and z");
        check(&changed("POINTS 2", "POINTS 0"), "1 or more");
        check(&changed("POINTS 2", "POINTS 99999999999"), "unpacks to at most");
    }
}
