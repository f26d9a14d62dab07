//! Triangles of a Wavefront OBJ file. What it says of materials, normals, textures, lines and curves is passed over.
//!
//! Read here, because a reader that keeps no lines cannot say where a file of a million lines is wrong.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use crate::simulate::document::Corners;

/// Most bytes of a file.
const MOST_BYTES: u64 = 1 << 30;
/// Most triangles of a mesh.
const MOST_TRIANGLES: usize = 20_000_000;

/// Reads all groups of a file as one body; polygons become fans of triangles.
pub(super) fn load(path: &Path) -> Result<Corners, String> {
    let name = path.display();
    if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("obj")) {
        return Err(format!("{name}: found another ending; expected a Wavefront file, NAME.obj"));
    }
    let file = File::open(path).map_err(|error| format!("{name}: cannot be read: {error}"))?;
    let bytes = file.metadata().map_err(|error| format!("{name}: cannot be read: {error}"))?.len();
    if bytes > MOST_BYTES {
        return Err(format!("{name}: found {bytes} bytes; expected at most {MOST_BYTES}"));
    }
    read(&mut BufReader::new(file)).map_err(|(line, problem)| match line {
        0 => format!("{name}: {problem}"),
        line => format!("{name}, line {line}: {problem}"),
    })
}

/// A problem and its line, from 1; 0 where it has none.
type Wrong = (usize, String);

fn read(from: &mut dyn BufRead) -> Result<Corners, Wrong> {
    let mut corners = Corners::default();
    // The largest corner that a face names, and where: it may stand below.
    let mut largest = (0, 0);
    let (mut text, mut number, mut is_going_on) = (Vec::new(), 0, false);
    loop {
        if !is_going_on {
            text.clear();
        }
        let count = from.read_until(b'\n', &mut text).map_err(|error| (0, format!("cannot be read: {error}")))?;
        if count == 0 && !is_going_on {
            break;
        }
        number += usize::from(count > 0);
        while matches!(text.last(), Some(b'\n' | b'\r')) {
            text.pop();
        }
        // A line that ends so goes on in the next.
        is_going_on = count > 0 && text.last() == Some(&b'\\');
        if is_going_on {
            text.pop();
            text.push(b' ');
            continue;
        }
        let line = String::from_utf8_lossy(&text);
        let mut words = line.split('#').next().unwrap_or_default().split_whitespace();
        let wrong = |expected: &str| {
            let shown: String = line.trim().chars().take(60).collect();
            (number, format!("found `{shown}`; expected {expected}"))
        };
        match words.next() {
            Some("v") => {
                corners.places.push(place(&mut words).ok_or_else(|| wrong("`v x y z`, three finite numbers"))?)
            }
            Some("f") => {
                let count = corners.places.len();
                let face: Option<Vec<usize>> = words.map(|word| corner(word, count)).collect();
                let face = face.filter(|face| face.len() >= 3).ok_or_else(|| {
                    wrong("`f a b c`, three or more numbers of corners from 1, or from -1 for those above it")
                })?;
                for pair in face[1..].windows(2) {
                    corners.triangles.push([face[0], pair[0], pair[1]]);
                }
                largest = face.iter().fold(largest, |most, at| if *at >= most.0 { (*at, number) } else { most });
                if corners.triangles.len() > MOST_TRIANGLES {
                    return Err((
                        number,
                        format!("found a triangle more than {MOST_TRIANGLES}; expected so many at most"),
                    ));
                }
            }
            _ => {}
        }
    }
    if corners.triangles.is_empty() {
        return Err((0, "found no face; expected lines `v x y z` and `f a b c`".to_owned()));
    }
    let (at, line) = largest;
    if at >= corners.places.len() {
        let places = corners.places.len();
        return Err((
            line,
            format!("found a face with corner {}; expected 1 to {places}, the corners of the file", at + 1),
        ));
    }
    Ok(corners)
}

fn place<'a>(words: &mut impl Iterator<Item = &'a str>) -> Option<[f64; 3]> {
    let mut number = || words.next()?.parse::<f64>().ok().filter(|number| number.is_finite());
    Some([number()?, number()?, number()?])
}

/// The number of a corner from 0, of `a`, `a/t`, `a//n` or `a/t/n`; those below 0 count back from the last.
fn corner(word: &str, count: usize) -> Option<usize> {
    let number: i64 = word.split('/').next()?.parse().ok()?;
    match number {
        1.. => usize::try_from(number - 1).ok(),
        0 => None,
        _ => count.checked_sub(usize::try_from(number.unsigned_abs()).ok()?),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test")]
mod tests {
    use super::*;
    use crate::simulate::Mesh;

    const WHOLE: &str = "# a roof\nmtllib none.mtl\no roof\nv 0 0 0 1\r\nv 1.5e0 0 0\nv 1 1 0\n\tv 0 1 -.5\nvn 0 0 1\nvt 0 0\n\
        usemtl red\nf 1/1/1 2//1 3/1 4\nf -1 -2 \\\n -3\nl 1 2\n";

    fn of(text: &[u8]) -> Result<Corners, Wrong> {
        read(&mut &*text)
    }

    #[test]
    fn a_file_has_the_corners_and_triangles_that_it_says() {
        let corners = of(WHOLE.as_bytes()).unwrap();
        assert_eq!(corners.places, [[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, -0.5]]);
        assert_eq!(corners.triangles, [[0, 1, 2], [0, 2, 3], [3, 2, 1]]);
        // A face may stand above its corners.
        assert_eq!(of(b"f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0").unwrap().triangles, [[0, 1, 2]]);
    }

    #[test]
    fn an_error_names_the_line() {
        for (old, new, expected) in [
            ("v 1 1 0", "v 1 1", (6, "found `v 1 1`; expected `v x y z`, three finite numbers")),
            ("v 1 1 0", "v 1 nan 0", (6, "found `v 1 nan 0`; expected `v x y z`")),
            ("v 1 1 0", "v 1 1e999 0", (6, "found `v 1 1e999 0`; expected `v x y z`")),
            ("3/1 4", "3/1 5", (11, "found a face with corner 5; expected 1 to 4")),
            ("3/1 4", "3/1 0", (11, "found `f 1/1/1 2//1 3/1 0`; expected `f a b c`")),
            ("3/1 4", "3/1 99999999999999999999", (11, "expected `f a b c`")),
            ("3/1 4", "3/1 9223372036854775807", (11, "found a face with corner 9223372036854775807")),
            ("-1 -2", "-1 -5", (13, "expected `f a b c`")),
            ("-1 -2", "-1 -9223372036854775808", (13, "expected `f a b c`")),
            ("f 1/1/1 2//1 3/1 4", "f 1 2", (11, "found `f 1 2`; expected `f a b c`, three or more")),
        ] {
            assert!(WHOLE.contains(old), "{old}");
            let (line, problem) = of(WHOLE.replacen(old, new, 1).as_bytes()).unwrap_err();
            assert!(line == expected.0 && problem.contains(expected.1), "{new}: line {line}: {problem}");
        }
        assert_eq!(of(b"hello").unwrap_err(), (0, "found no face; expected lines `v x y z` and `f a b c`".to_owned()));
    }

    /// Numbers that mean nothing, the same for every run.
    fn numbers(mut state: u64) -> impl FnMut(usize) -> usize {
        move |below| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % below
        }
    }

    #[test]
    fn no_bytes_end_the_program_and_what_is_read_makes_a_mesh_or_a_sentence() {
        let mut draw = numbers(1);
        let (mut read, mut meshes) = (0, 0);
        let words: [&[u8]; 16] = [
            b"v 1e308 -1e308 0\n",
            b"f 1 1 1\n",
            b"f 1 2 3\n",
            b"nan",
            b"-",
            b"/",
            b"\\\n",
            b"\n",
            b"\xff\xfe",
            b"#",
            b"1e13 ",
            b"f -1 -2 -3\n",
            b"v 0 0 0\n",
            b"99999999999",
            b"\0",
            b"f 4 3 2 1 2 3 4\n",
        ];
        for _ in 0..50_000 {
            let mut bytes = if draw(4) == 0 { Vec::new() } else { WHOLE.as_bytes().to_vec() };
            for _ in 0..draw(12) {
                let at = draw(bytes.len() + 1);
                match draw(4) {
                    0 => bytes.truncate(at),
                    1 => bytes.insert(at, draw(256) as u8),
                    2 if at < bytes.len() => bytes[at] ^= 1 << draw(8),
                    _ => drop(bytes.splice(at..at, words[draw(words.len())].iter().copied())),
                }
            }
            match of(&bytes) {
                Ok(corners) => {
                    read += 1;
                    assert!(corners.triangles.iter().flatten().all(|corner| *corner < corners.places.len()));
                    match Mesh::new(&corners.places, &corners.triangles) {
                        Ok(_) => meshes += 1,
                        Err(why) => assert!(why.to_string().contains("expected"), "{why}"),
                    }
                }
                Err((line, problem)) => {
                    assert!(problem.contains("expected"), "{problem}");
                    assert!(line <= bytes.iter().filter(|byte| **byte == b'\n').count() + 1);
                }
            }
        }
        assert!(read > 5000 && meshes > 5000, "{read} {meshes}");
    }
}
