//! The first animation of a glTF file: key frames of translations, rotations and scales of nodes.
//!
//! The weights of morph targets are those of time 0. A faulty channel is left out with a notice.

use super::accessor::Accessor;
use super::buffers::Buffers;
use super::json::Json;
use super::tree::{NodeTransform, node_transform};
use crate::mesh_file::fault::MeshFault;
use crate::mesh_file::motion::{Channel, Interpolation, KeyTimes, Track};
use crate::progress::Meter;
use glam::DMat4;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

/// The first animation of a file.
#[derive(Default)]
pub(super) struct Animation {
    /// The tracks of the nodes that have any, by the index of the node.
    nodes: HashMap<usize, NodeTracks>,
    /// The weights of morph targets at time 0, by the index of the node.
    weights: HashMap<usize, Vec<f64>>,
    /// The time of the last key frame in seconds.
    length: f64,
}

/// The key frames of a node.
#[derive(Default)]
struct NodeTracks {
    translation: Option<Track<3>>,
    rotation: Option<Track<4>>,
    scale: Option<Track<3>>,
    /// Whether a value changes with the time.
    moves: bool,
}

/// The channels of a moving node.
pub(super) struct NodeChannels {
    pub(super) translation: Channel<3>,
    pub(super) rotation: Channel<4>,
    pub(super) scale: Channel<3>,
}

impl Animation {
    /// Reads the first animation, and counts the others as not shown.
    pub(super) fn read<'a>(
        root: Json<'a>,
        buffers: &mut Buffers<'a, '_>,
        meter: &mut Meter<'_>,
    ) -> Result<Self, MeshFault> {
        // A fault of an animation is no reason to refuse the shape.
        let mut animations = match root.list("animations") {
            Ok(animations) => animations,
            Err(fault) => {
                buffers.left_out().notify_of(fault, "not played")?;
                return Ok(Self::default());
            }
        };
        let Some(animation) = animations.next() else { return Ok(Self::default()) };
        buffers.left_out().not_shown("animation (after the first)", animations.count());
        let mut reader = Reader { animation, buffers, read: Self::default(), samples: Samples::default() };
        // Of either kind of fault the first is told.
        let (mut is_fault_told, mut is_missing_file_told) = (false, false);
        for channel in animation.list("channels").into_iter().flatten() {
            meter.report_indeterminate()?;
            let Err(fault) = reader.channel(channel) else { continue };
            let is_told = if fault.is_of_side_file() { &mut is_missing_file_told } else { &mut is_fault_told };
            if std::mem::replace(is_told, true) {
                reader.buffers.left_out().not_shown("faulty channel (of the animation)", 1);
            } else {
                reader.buffers.left_out().notify_of(fault, "this channel is not played")?;
            }
        }
        if let Err(fault) = animation.list("channels").map(drop) {
            reader.buffers.left_out().notify_of(fault, "not played")?;
        }
        Ok(reader.read)
    }

    /// Returns the length in seconds.
    pub(super) fn length(&self) -> f64 {
        self.length
    }

    /// Returns whether any node moves.
    pub(super) fn moves(&self) -> bool {
        self.length > 0.0 && self.nodes.values().any(|tracks| tracks.moves)
    }

    /// Returns whether a node itself moves in its parent's coordinates.
    pub(super) fn moves_node(&self, number: usize) -> bool {
        self.length > 0.0 && self.nodes.get(&number).is_some_and(|tracks| tracks.moves)
    }

    /// Returns the weights of a node's morph targets at time 0, if they are animated.
    pub(super) fn weights(&self, number: usize) -> Option<&Vec<f64>> {
        self.weights.get(&number)
    }

    /// Returns the transform from a node's coordinates to its parent's, at time 0.
    pub(super) fn local_transform(&self, number: usize, node: Json<'_>) -> Result<DMat4, MeshFault> {
        let mut transform = node_transform(node)?;
        if let (Some(tracks), NodeTransform::Parts { translation, rotation, scale }) =
            (self.nodes.get(&number), &mut transform)
        {
            let set = |part: &mut [f64; 3], track: &Option<Track<3>>| {
                *part = track.as_ref().map_or(*part, |track| track.at(0.0));
            };
            set(translation, &tracks.translation);
            set(scale, &tracks.scale);
            *rotation = tracks.rotation.as_ref().map_or(*rotation, |track| track.at(0.0));
        }
        transform.matrix().ok_or_else(|| node.fault(super::tree::NO_ROTATION))
    }

    /// Returns the channels of a node that moves.
    pub(super) fn channels(&self, number: usize, node: Json<'_>) -> Result<Option<NodeChannels>, MeshFault> {
        let (Some(tracks), NodeTransform::Parts { translation, rotation, scale }) =
            (self.nodes.get(&number), node_transform(node)?)
        else {
            return Ok(None);
        };
        let vector = |track: &Option<Track<3>>, own| track.clone().map_or(Channel::Constant(own), Channel::Track);
        Ok(Some(NodeChannels {
            translation: vector(&tracks.translation, translation),
            rotation: tracks.rotation.clone().map_or(Channel::Constant(rotation), Channel::Track),
            scale: vector(&tracks.scale, scale),
        }))
    }
}

/// The times and values of key frames read so far, by the index of their accessor.
#[derive(Default)]
struct Samples {
    times: HashMap<usize, KeyTimes>,
    vectors: HashMap<usize, Values<3>>,
    rotations: HashMap<usize, Values<4>>,
    /// Number of all elements that were read.
    count: usize,
}

/// The values of an accessor.
#[derive(Clone)]
struct Values<const N: usize> {
    all: Arc<[[f32; N]]>,
    /// Whether all are the same.
    is_constant: bool,
    /// Whether any value is zero.
    has_zero: bool,
    /// Whether any middle value of three is zero: in a spline the others are tangents.
    has_zero_at_key: bool,
}

impl<const N: usize> From<Vec<[f32; N]>> for Values<N> {
    fn from(all: Vec<[f32; N]>) -> Self {
        let is_zero = |value: &[f32; N]| *value == [0.0; N];
        Self {
            is_constant: all.iter().all(|value| *value == all[0]),
            has_zero: all.iter().any(is_zero),
            has_zero_at_key: all.iter().skip(1).step_by(3).any(is_zero),
            all: all.into(),
        }
    }
}

struct Reader<'r, 'a, 'b> {
    animation: Json<'a>,
    buffers: &'r mut Buffers<'a, 'b>,
    read: Animation,
    samples: Samples,
}

impl<'a> Reader<'_, 'a, '_> {
    fn channel(&mut self, channel: Json<'a>) -> Result<(), MeshFault> {
        let target = channel.required("target")?;
        let path = target.required("path")?;
        let Some(index) = target.field("node")? else {
            self.buffers.left_out().not_shown("animation (of other things than nodes)", 1);
            return Ok(());
        };
        let (number, node) = index.item_of(self.buffers.root(), "nodes")?;
        if node.field("matrix")?.is_some() {
            return Err(target.fault("a node with a matrix cannot be animated"));
        }
        let (_, sampler) = channel.required("sampler")?.item_of(self.animation, "samplers")?;
        let entry = self.read.nodes.get(&number);
        let is_taken = match path.string()? {
            "translation" => entry.is_some_and(|tracks| tracks.translation.is_some()),
            "rotation" => entry.is_some_and(|tracks| tracks.rotation.is_some()),
            "scale" => entry.is_some_and(|tracks| tracks.scale.is_some()),
            "weights" => return self.weights(target, sampler, number),
            other => {
                let known = "translation, rotation, scale or weights";
                return Err(path.fault(format!("expected {known}, found {}", super::shown(other.as_bytes()))));
            }
        };
        if is_taken {
            return Err(target.fault("two channels have this target"));
        }
        match path.string()? {
            "rotation" => {
                let (track, moves) = self.track(sampler, |samples| &mut samples.rotations)?;
                let tracks = self.read.nodes.entry(number).or_default();
                (tracks.rotation, tracks.moves) = (Some(track), tracks.moves || moves);
            }
            name => {
                let (track, moves) = self.track(sampler, |samples| &mut samples.vectors)?;
                let tracks = self.read.nodes.entry(number).or_default();
                let place = if name == "scale" { &mut tracks.scale } else { &mut tracks.translation };
                (*place, tracks.moves) = (Some(track), tracks.moves || moves);
            }
        }
        Ok(())
    }

    /// Reads the key frames of a sampler, and whether their values change with the time.
    fn track<const N: usize>(
        &mut self,
        sampler: Json<'a>,
        values_of: fn(&mut Samples) -> &mut HashMap<usize, Values<N>>,
    ) -> Result<(Track<N>, bool), MeshFault> {
        let (times, interpolation) = self.times(sampler)?;
        let output = sampler.required("output")?;
        let (index, _) = output.item_of(self.buffers.root(), "accessors")?;
        let values = if let Some(known) = values_of(&mut self.samples).get(&index) {
            known.clone()
        } else {
            let accessor = Accessor::read(output, self.buffers)?;
            self.samples.count(&accessor, self.buffers)?;
            let values = Values::from(accessor.vectors::<N>()?);
            values_of(&mut self.samples).insert(index, values.clone());
            values
        };
        let is_spline = interpolation == Interpolation::CubicSpline;
        if N == 4 && (if is_spline { values.has_zero_at_key } else { values.has_zero }) {
            return Err(output.fault("a rotation is not a quaternion: its length is zero"));
        }
        let (keys, count) = (times.count(), values.all.len());
        let moves = keys > 1 && (!values.is_constant || is_spline);
        let length = times.last();
        let track = Track::new(times, values.all, interpolation).ok_or_else(|| {
            let wanted = keys.saturating_mul(interpolation.values_per_key());
            output.fault(format!("{keys} key frames need {wanted} values, found {count}"))
        })?;
        self.read.length = self.read.length.max(length);
        Ok((track, moves))
    }

    /// Reads the times of a sampler, and how the values between them follow.
    fn times(&mut self, sampler: Json<'a>) -> Result<(KeyTimes, Interpolation), MeshFault> {
        let interpolation = match sampler.field("interpolation")?.map(Json::string).transpose()? {
            None | Some("LINEAR") => Interpolation::Linear,
            Some("STEP") => Interpolation::Step,
            Some("CUBICSPLINE") => Interpolation::CubicSpline,
            Some(other) => {
                let found = super::shown(other.as_bytes());
                return Err(sampler.fault(format!("expected LINEAR, STEP or CUBICSPLINE, found {found}")));
            }
        };
        let input = sampler.required("input")?;
        let (index, _) = input.item_of(self.buffers.root(), "accessors")?;
        let times = match self.samples.times.entry(index) {
            Entry::Occupied(known) => known.get().clone(),
            Entry::Vacant(_) => {
                let accessor = Accessor::read(input, self.buffers)?;
                self.samples.count(&accessor, self.buffers)?;
                let times: Vec<f32> = accessor.vectors::<1>()?.into_iter().map(|[time]| time).collect();
                if let Some(at) = times.windows(2).position(|pair| pair[1] < pair[0]) {
                    let [time, next] = [times[at], times[at + 1]];
                    let message = format!("the times of key frames must not decrease: {time} is followed by {next}");
                    return Err(accessor.fault(message));
                }
                if let Some(first) = times.first().filter(|&&first| first < 0.0) {
                    return Err(accessor.fault(format!("the time {first} of a key frame is negative")));
                }
                let times = KeyTimes::new(times).ok_or_else(|| accessor.fault("there are no key frames"))?;
                self.samples.times.insert(index, times.clone());
                times
            }
        };
        Ok((times, interpolation))
    }

    /// Reads the weights of morph targets at time 0.
    fn weights(&mut self, target: Json<'a>, sampler: Json<'a>, number: usize) -> Result<(), MeshFault> {
        if self.read.weights.contains_key(&number) {
            return Err(target.fault("two channels have this target"));
        }
        let (times, interpolation) = self.times(sampler)?;
        let accessor = Accessor::read(sampler.required("output")?, self.buffers)?;
        self.samples.count(&accessor, self.buffers)?;
        let values = accessor.vectors::<1>()?;
        let (keys, values_per_key) = (times.count(), interpolation.values_per_key());
        let targets = values.len() / (keys * values_per_key);
        if targets == 0 || targets * keys * values_per_key != values.len() {
            return Err(accessor.fault(format!("{} values are not those of {keys} key frames", values.len())));
        }
        // Before the values of the first key frame, a cubic spline has its incoming tangents.
        let first = if interpolation == Interpolation::CubicSpline { targets } else { 0 };
        let weights = values[first..first + targets].iter().map(|&[weight]| f64::from(weight));
        self.read.weights.insert(number, weights.collect());
        self.read.length = self.read.length.max(times.last());
        let at_start = &values[first..first + targets];
        // A spline with equal values is constant where its tangents are 0.
        let is_constant = values.chunks(targets).enumerate().all(|(at, chunk)| match (values_per_key, at % 3) {
            (3, 0 | 2) => chunk.iter().all(|tangent| *tangent == [0.0]),
            _ => chunk == at_start,
        });
        if !is_constant {
            self.buffers.left_out().not_shown("animation (of morph targets)", 1);
        }
        Ok(())
    }
}

impl Samples {
    /// Counts the elements of an accessor that will be read.
    ///
    /// # Errors
    /// If there are too many: accessors may overlap, so that the size of the file does not limit them.
    fn count(&mut self, accessor: &Accessor<'_>, buffers: &Buffers<'_, '_>) -> Result<(), MeshFault> {
        self.count = self.count.saturating_add(accessor.count);
        if self.count > buffers.max_elements() {
            return Err(accessor.fault("too many key frames for a file of this size"));
        }
        Ok(())
    }
}
