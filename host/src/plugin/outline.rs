//! A module's outline, read before anything is compiled: compiling cannot be stopped, so what could take long is refused first.

use bidir_abi::{export, limit, manifest};
use wasmparser::{ExternalKind, FunctionBody, Operator, Parser, Payload, ValType};

use super::manifest::Kind;

/// Bytes of one function's code.
const MAX_BODY_BYTES: usize = 64 << 10;

/// Local variables of one function.
const MAX_LOCALS: u32 = 1_000;

/// Local variables of all functions together.
const MAX_LOCALS_TOGETHER: u64 = 100_000;

/// Blocks inside each other.
const MAX_DEPTH: u32 = 1_000;

/// Loops inside each other: what they change is carried around every one of them, and compiling takes the square of that.
const MAX_LOOPS: u32 = 16;

/// Values that the compiler may have to carry to the ends of branches: all branches and blocks, times what lives there.
const MAX_CARRIED: u64 = 1_000_000;

/// Parameters and results of one function type.
const MAX_WIDTH: u32 = 100;

/// Globals, and data and element segments, each.
const MAX_PARTS: u32 = 1_000;

/// A function's parameters and results.
type Signature = (Vec<ValType>, Vec<ValType>);

/// What a module is made of.
#[derive(Debug, Default)]
pub(super) struct Outline<'a> {
    /// The custom section, if there is one.
    pub(super) manifest: Option<&'a [u8]>,
    /// Functions and memories by name, in the order of the file; the signature of a function in words.
    pub(super) exports: Vec<(String, String)>,
    /// Functions.
    pub(super) functions: u32,
    types: Vec<Option<Signature>>,
    type_of: Vec<u32>,
    signatures: Vec<(String, Option<Signature>)>,
    memories: u32,
    locals: u64,
    /// The most parameters and results that a type has.
    width: u64,
    carried: u64,
}

impl<'a> Outline<'a> {
    /// Reads the outline of a module.
    ///
    /// # Errors
    /// In one clause, why it is refused.
    pub(super) fn read(bytes: &'a [u8]) -> Result<Self, String> {
        if bytes.is_empty() {
            return Err("the file is empty".to_owned());
        }
        if !Parser::is_core_wasm(bytes) {
            let component = if Parser::is_component(bytes) { "a component, not a core module" } else { "not a WebAssembly module" };
            return Err(format!("the file is {component}"));
        }
        let mut outline = Self::default();
        for payload in Parser::new(0).parse_all(bytes) {
            outline.take(payload.map_err(broken)?)?;
        }
        Ok(outline)
    }

    fn take(&mut self, payload: Payload<'a>) -> Result<(), String> {
        match payload {
            Payload::TypeSection(types) => {
                at_most("types", types.count(), limit::MAX_FUNCTIONS)?;
                for group in types {
                    for one in group.map_err(broken)?.into_types() {
                        let function = match one.composite_type.inner {
                            wasmparser::CompositeInnerType::Func(function) => {
                                let width = (function.params().len() + function.results().len()) as u32;
                                at_most("parameters and results of one type", width, MAX_WIDTH)?;
                                self.width = self.width.max(u64::from(width));
                                Some((function.params().to_vec(), function.results().to_vec()))
                            }
                            _ => None,
                        };
                        self.types.push(function);
                    }
                }
            }
            Payload::ImportSection(imports) => {
                if let Some(import) = imports.into_imports().next() {
                    let import = import.map_err(broken)?;
                    return Err(format!(
                        "the module imports \"{}\" from \"{}\", and a plugin may import nothing",
                        import.name, import.module
                    ));
                }
            }
            Payload::FunctionSection(functions) => {
                at_most("functions", functions.count(), limit::MAX_FUNCTIONS)?;
                self.functions = functions.count();
                self.type_of = functions.into_iter().collect::<Result<_, _>>().map_err(broken)?;
            }
            Payload::MemorySection(memories) => {
                self.memories = memories.count();
                for memory in memories {
                    let bytes = memory.map_err(broken)?.initial.saturating_mul(64 << 10);
                    if bytes > limit::MAX_MEMORY_BYTES as u64 {
                        return Err(format!("its memory has {bytes} bytes, and may have {}", limit::MAX_MEMORY_BYTES));
                    }
                }
            }
            Payload::TableSection(tables) => {
                at_most("tables", tables.count(), 1)?;
                for table in tables {
                    let entries = table.map_err(broken)?.ty.initial;
                    at_most("table entries", u32::try_from(entries).unwrap_or(u32::MAX), limit::MAX_TABLE_ENTRIES as u32)?;
                }
            }
            Payload::GlobalSection(globals) => at_most("globals", globals.count(), MAX_PARTS)?,
            Payload::DataSection(data) => at_most("data segments", data.count(), MAX_PARTS)?,
            Payload::ElementSection(elements) => at_most("element segments", elements.count(), MAX_PARTS)?,
            Payload::ExportSection(exports) => {
                at_most("exports", exports.count(), MAX_PARTS)?;
                for one in exports {
                    let one = one.map_err(broken)?;
                    self.export(one.name, one.kind, one.index);
                }
            }
            Payload::CodeSectionEntry(body) => self.body(&body)?,
            Payload::CustomSection(section) if section.name() == manifest::SECTION => self.manifest = Some(section.data()),
            _ => {}
        }
        Ok(())
    }

    fn export(&mut self, name: &str, kind: ExternalKind, index: u32) {
        match kind {
            ExternalKind::Func => {
                let of = self.type_of.get(index as usize).and_then(|index| self.types.get(*index as usize));
                let signature = of.cloned().flatten();
                self.exports.push((name.to_owned(), signature.as_ref().map_or_else(|| "?".to_owned(), words)));
                self.signatures.push((name.to_owned(), signature));
            }
            ExternalKind::Memory => self.exports.push((name.to_owned(), "memory".to_owned())),
            _ => {}
        }
    }

    fn body(&mut self, body: &FunctionBody) -> Result<(), String> {
        at_most("bytes in one function", u32::try_from(body.range().len()).unwrap_or(u32::MAX), MAX_BODY_BYTES as u32)?;
        let mut locals = 0u64;
        for group in body.get_locals_reader().map_err(broken)? {
            locals += u64::from(group.map_err(broken)?.0);
        }
        self.locals += locals;
        at_most("locals in one function", u32::try_from(locals).unwrap_or(u32::MAX), MAX_LOCALS)?;
        at_most("locals", u32::try_from(self.locals).unwrap_or(u32::MAX), MAX_LOCALS_TOGETHER as u32)?;
        // Parameters of the function and operands of its blocks are both at most as many as the widest type has.
        self.carried += branches(body)? * (1 + locals + 2 * self.width);
        at_most("branches times locals", u32::try_from(self.carried).unwrap_or(u32::MAX), MAX_CARRIED as u32)
    }

    /// Checks that everything is exported that a module of that kind has to.
    pub(super) fn check_exports(&self, kind: Kind) -> Result<(), String> {
        if self.memories != 1 || !self.exports.iter().any(|(name, what)| name == export::MEMORY && what == "memory") {
            return Err(format!("the module has to have one memory, and to export it as \"{}\"", export::MEMORY));
        }
        let (i, f) = (ValType::I32, ValType::F32);
        let bsdf = [vec![i; 3], vec![f; 6]].concat();
        let mut needed = vec![(export::ABI, vec![], vec![i]), (export::SCRATCH, vec![i], vec![i])];
        match kind {
            Kind::Bsdf => needed.extend([(export::BSDF_EVAL, bsdf.clone(), vec![]), (export::BSDF_SAMPLE, bsdf, vec![])]),
            Kind::Light => needed.extend([
                (export::LIGHT_EMIT, [vec![i; 2], vec![f; 4]].concat(), vec![]),
                (export::LIGHT_EVAL, [vec![i; 2], vec![f; 5]].concat(), vec![]),
            ]),
        }
        let optional = [(export::BSDF_EVAL_N, vec![i; 4], vec![]), (export::BSDF_VERTEX, [vec![i; 3], vec![f; 9]].concat(), vec![])];
        let there = |name: &str| self.signatures.iter().any(|(known, _)| known == name);
        needed.extend(optional.into_iter().filter(|(name, ..)| kind == Kind::Bsdf && there(name)));
        for (name, parameters, results) in needed {
            let expected = (parameters, results);
            let Some((_, signature)) = self.signatures.iter().find(|(known, _)| known == name) else {
                return Err(format!("the module exports no \"{name}\", which a {} needs as {}", kind.name(), words(&expected)));
            };
            if signature.as_ref() != Some(&expected) {
                let is = signature.as_ref().map_or_else(|| "something else".to_owned(), words);
                return Err(format!("the export \"{name}\" is {is}, and has to be {}", words(&expected)));
            }
        }
        Ok(())
    }
}

/// How many blocks and ways out of them a function has.
fn branches(body: &FunctionBody) -> Result<u64, String> {
    let mut count = 0;
    // Of each open block, whether it is a loop.
    let mut open: Vec<bool> = Vec::new();
    let mut loops = 0;
    for operator in body.get_operators_reader().map_err(broken)? {
        let operator = operator.map_err(broken)?;
        match operator {
            Operator::Block { .. } | Operator::Loop { .. } | Operator::If { .. } => {
                let is_loop = matches!(operator, Operator::Loop { .. });
                count += 1;
                loops += u32::from(is_loop);
                open.push(is_loop);
                at_most("loops inside each other", loops, MAX_LOOPS)?;
                at_most("blocks inside each other", open.len() as u32, MAX_DEPTH)?;
            }
            Operator::Else | Operator::Br { .. } | Operator::BrIf { .. } => count += 1,
            Operator::BrTable { targets } => count += 1 + u64::from(targets.len()),
            Operator::End => loops -= u32::from(open.pop().unwrap_or(false)),
            _ => {}
        }
    }
    Ok(count)
}

fn words((parameters, results): &Signature) -> String {
    let list = |types: &[ValType]| types.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
    format!("({}) -> ({})", list(parameters), list(results))
}

fn at_most(what: &str, count: u32, most: u32) -> Result<(), String> {
    if count <= most { Ok(()) } else { Err(format!("the module has {count} {what}, and may have {most}")) }
}

fn broken(error: wasmparser::BinaryReaderError) -> String {
    format!("the module is broken at byte {}: {}", error.offset(), error.message())
}
