// Errors as the library states them.

/** An error of the library: its sentence as `message`, and what it is as `code`. */
export class TesseraError extends Error {
  /**
   * `code`: 'invalid_argument', 'parse_error', ..., the names of tsr_status_name(); `index`: the element that the
   * sentence names, or -1.
   */
  constructor(code, message, index = -1) {
    super(message);
    this.name = 'TesseraError';
    this.code = code;
    this.index = index;
  }
}

export const invalid = (message) => new TesseraError('invalid_argument', message);
