// Names of members that the package's own files share and that its users do not see.
export const its = {
  module: Symbol('module'), handle: Symbol('handle'), struct: Symbol('struct'), refresh: Symbol('refresh'),
  resize: Symbol('resize'), takeEdges: Symbol('takeEdges'), plan: Symbol('plan'),
};
