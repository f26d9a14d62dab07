//! Triangles of a Wavefront OBJ file. What it says of materials, normals and textures is passed over.

use std::fs::File;
use std::io::BufReader;
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
    let options = tobj::LoadOptions { triangulate: true, ..tobj::LoadOptions::default() };
    let none = |_: &Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut BufReader::new(file), &options, none)
        .map_err(|error| format!("{name}: found no Wavefront OBJ: {error}; expected lines `v x y z` and `f a b c`"))?;
    let mut corners = Corners::default();
    for model in models {
        let first = corners.places.len();
        corners.places.extend(model.mesh.positions.chunks_exact(3).map(|place| [place[0], place[1], place[2]]));
        let triangles = model.mesh.indices.chunks_exact(3);
        corners
            .triangles
            .extend(triangles.map(|three| [three[0], three[1], three[2]].map(|corner| first + corner as usize)));
    }
    if corners.triangles.len() > MOST_TRIANGLES {
        return Err(format!("{name}: found {} triangles; expected at most {MOST_TRIANGLES}", corners.triangles.len()));
    }
    Ok(corners)
}
