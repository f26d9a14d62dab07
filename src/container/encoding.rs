//! How a file is encoded, as far as it decides who can open it: everything that is legal HDF5 and that some program
//! cannot read.

use hdf5_reader::messages::HdfMessage;
use hdf5_reader::messages::dataspace::DataspaceType;
use hdf5_reader::messages::datatype::Datatype;
use hdf5_reader::object_header::ObjectHeader;

/// An encoding that the standard does not use.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Construct {
    /// A filter other than shuffle, deflate and fletcher32, by its registered number.
    Filter(u16),
    /// Floating-point numbers of 2 bytes.
    HalfFloat,
    /// A dataset without a dataspace.
    NullDataspace,
    /// A soft link that leads nowhere, with its target.
    DanglingLink(String),
    /// Strings of variable length.
    VariableString,
    /// Sequences of variable length.
    VariableLength,
    /// References to objects, other than those that attach dimension scales.
    Reference,
    /// A group or dataset that does not keep the order in which its members or attributes were made.
    NoCreationOrder,
    /// A `_FillValue` of another type than the values.
    FillValueType,
    /// An enumeration, as h5py writes truth values.
    Enumeration,
    /// A compound, array, opaque or bit-field type.
    Compound(&'static str),
    /// Numbers with their most significant byte first.
    BigEndian,
    /// A block of foreign bytes before the file, of so many bytes.
    UserBlock(u64),
    /// A superblock other than version 0, 2 or 3.
    Superblock(u8),
    /// An axis without a dimension scale, of so many axes.
    NoScale(usize),
}

/// A construct with the path of the object; `@` precedes an attribute.
pub type Encoded = (String, Construct);

/// Attributes whose references attach dimension scales.
const SCALE_REFERENCES: [&str; 2] = ["DIMENSION_LIST", "REFERENCE_LIST"];
/// Filters that every reader has.
const USUAL_FILTERS: [u16; 3] = [1, 2, 3];

/// The constructs in the type of a dataset or an attribute.
fn of_type(kind: &Datatype) -> Option<Construct> {
    use hdf5_reader::ByteOrder::BigEndian;
    match kind {
        Datatype::FloatingPoint { size: 2, .. } => Some(Construct::HalfFloat),
        Datatype::FixedPoint { size: 2.., byte_order: BigEndian, .. }
        | Datatype::FloatingPoint { byte_order: BigEndian, .. } => Some(Construct::BigEndian),
        Datatype::FixedPoint { .. } | Datatype::FloatingPoint { .. } => None,
        Datatype::String { size: hdf5_reader::StringSize::Variable, .. } => Some(Construct::VariableString),
        Datatype::String { .. } => None,
        Datatype::VarLen { kind: hdf5_reader::VarLenKind::String, .. } => Some(Construct::VariableString),
        Datatype::VarLen { .. } => Some(Construct::VariableLength),
        Datatype::Reference { .. } => Some(Construct::Reference),
        Datatype::Enum { .. } => Some(Construct::Enumeration),
        Datatype::Compound { .. } => Some(Construct::Compound("compound")),
        Datatype::Array { .. } => Some(Construct::Compound("array")),
        Datatype::Opaque { .. } => Some(Construct::Compound("opaque")),
        Datatype::Bitfield { .. } => Some(Construct::Compound("bit-field")),
    }
}

/// The constructs of the attributes of an object.
pub(super) fn of_attributes(attributes: &[hdf5_reader::Attribute], path: &str, found: &mut Vec<Encoded>) {
    for attribute in attributes.iter().filter(|attribute| !SCALE_REFERENCES.contains(&attribute.name.as_str())) {
        found.extend(of_type(&attribute.datatype).map(|construct| (format!("{path}@{}", attribute.name), construct)));
    }
}

/// The constructs of a group's header.
pub(super) fn of_group(header: &ObjectHeader, path: &str, found: &mut Vec<Encoded>) {
    let ordered = header.messages.iter().any(|message| match message {
        HdfMessage::LinkInfo(info) => info.creation_order_tracked,
        _ => false,
    });
    if !ordered {
        found.push((path.to_owned(), Construct::NoCreationOrder));
    }
}

/// Why this reader does not have the values of a dataset, though they may be undamaged.
pub(super) fn unreadable(header: &ObjectHeader) -> Option<String> {
    let is_null = header.messages.iter().any(|message| match message {
        HdfMessage::Dataspace(space) => space.dataspace_type == DataspaceType::Null,
        _ => false,
    });
    let filter = filters(header).first().map(|filter| format!("what filter {filter} made of it"));
    filter.or_else(|| is_null.then(|| "nothing (a null dataspace)".to_owned()))
}

/// The filters of a dataset that not every reader has.
fn filters(header: &ObjectHeader) -> Vec<u16> {
    let pipelines = header.messages.iter().filter_map(|message| match message {
        HdfMessage::FilterPipeline(pipeline) => Some(pipeline),
        _ => None,
    });
    pipelines
        .flat_map(|pipeline| pipeline.filters.iter().map(|filter| filter.id))
        .filter(|id| !USUAL_FILTERS.contains(id))
        .collect()
}

/// The constructs of a dataset.
pub(super) fn of_dataset(dataset: &hdf5_reader::Dataset, header: &ObjectHeader, path: &str, found: &mut Vec<Encoded>) {
    let mut add = |construct| found.push((path.to_owned(), construct));
    filters(header).into_iter().map(Construct::Filter).for_each(&mut add);
    of_type(dataset.dtype()).into_iter().for_each(&mut add);
    let (mut ordered, mut has_attributes) = (false, false);
    for message in &header.messages {
        match message {
            HdfMessage::Dataspace(space) if space.dataspace_type == DataspaceType::Null => {
                add(Construct::NullDataspace)
            }
            HdfMessage::AttributeInfo(info) => ordered = info.creation_order_tracked,
            HdfMessage::Attribute(_) => has_attributes = true,
            _ => {}
        }
    }
    if has_attributes && !ordered {
        add(Construct::NoCreationOrder);
    }
    let attributes = dataset.attributes();
    if attributes.iter().any(|attribute| attribute.name == "_FillValue" && attribute.datatype != *dataset.dtype()) {
        add(Construct::FillValueType);
    }
    let is_scale = attributes.iter().any(|attribute| attribute.name == "CLASS");
    let scaled = attributes.iter().any(|attribute| attribute.name == "DIMENSION_LIST");
    if !is_scale && !scaled && dataset.ndim() > 0 {
        add(Construct::NoScale(dataset.ndim()));
    }
}

/// The constructs of the file as a whole.
pub(super) fn of_file(file: &hdf5_reader::Hdf5File, found: &mut Vec<Encoded>) {
    let superblock = file.superblock();
    if superblock.base_address > 0 {
        found.push(("/".to_owned(), Construct::UserBlock(superblock.base_address)));
    }
    if !matches!(superblock.version, 0 | 2 | 3) {
        found.push(("/".to_owned(), Construct::Superblock(superblock.version)));
    }
}
