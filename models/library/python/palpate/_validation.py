"""Cross-validation of any estimator on the folds of a fit."""
import dataclasses
from typing import Any, Dict, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._library import Error, doubles
from ._models import fit_without, within_jnd
from ._recordings import as_recordings, find_folds, motion_of


@dataclasses.dataclass(frozen=True)
class CrossValidation:
    """The result of `cross_validate`.

    Attributes
    ----------
    force_N : ndarray, shape (n,)
        The force at each sample, by the estimator that was fitted without the sample's fold.
    folds : ndarray of int, shape (n,)
    within_jnd : float
        Share of the samples in contact within the JND.
    rms_error_N : float
        Over the samples in contact.
    """

    force_N: NDArray[np.float64]
    folds: NDArray[np.int32]
    within_jnd: float
    rms_error_N: float


class Estimator:
    """The fit of this package for `cross_validate`, on recordings instead of features.

    Parameters
    ----------
    **options
        Of `fit`.

    Notes
    -----
    In a fit without a fold, the motion of the fold's samples still updates the filters, but their forces are not
    used, except those of the first touch if the surface is estimated. The model renders the whole motion.
    """

    def __init__(self, **options: Any):
        self.options: Dict[str, Any] = options

    def fit_predict(self, recordings: object, train: NDArray[np.bool_]) -> NDArray[np.float64]:
        """Fits to the rows of `train` and renders all rows.

        Parameters
        ----------
        recordings : list of recordings, or one
        train : ndarray of bool, shape (n,)
            Of all recordings one after the other.

        Returns
        -------
        ndarray, shape (n,)
        """
        recordings = as_recordings(recordings)
        left_out = np.split(~np.asarray(train), np.cumsum([len(one) for one in recordings])[:-1])
        # Whole recordings that are left out would still count in the surfaces of the others.
        kept = [index for index, part in enumerate(left_out) if not part.all()]
        model = fit_without([np.ascontiguousarray(left_out[index]) for index in kept],
                            [recordings[index] for index in kept], **self.options)
        return np.concatenate([model.render(**motion_of(one))[0] for one in recordings])


def cross_validate(features: object, force_N: ArrayLike, estimator: Any,
                   folds: Optional[ArrayLike] = None) -> CrossValidation:
    """Compares an estimator's forces with measured ones that it was not fitted to.

    Parameters
    ----------
    features : array_like, shape (n, d); or recordings
        One row a sample, the first column greater than 0 in contact (the depth of `Model.features`); for an
        `Estimator` the recordings themselves.
    force_N : array_like, shape (n,)
        The measured forces, of all recordings one after the other.
    estimator : object
        With ``fit(features, force_N)`` and ``predict(features)``, as in scikit-learn, or an `Estimator`. It is
        fitted to samples in contact, once for each fold.
    folds : array_like of int, shape (n,), optional
        By default `find_folds` of the first column, or of the positions of the recordings.

    Returns
    -------
    CrossValidation

    Examples
    --------
    >>> u = model.features(rec["time_s"], rec["position_m"])
    >>> palpate.cross_validate(u, rec["force_N"], RandomForestRegressor()).within_jnd
    >>> palpate.cross_validate([rec], rec["force_N"], palpate.Estimator(method="greedy"),
    ...                        folds=palpate.find_folds(u[:, 0])).within_jnd
    """
    force_N = doubles("force_N", force_N)
    if isinstance(estimator, Estimator):
        recordings = as_recordings(features)
        depths_m = [one["position_m"] for one in recordings]
    else:
        features = doubles("features", features, (len(force_N), None))
        depths_m = [features[:, 0]]
    contact = np.concatenate(depths_m) > 0.0
    if contact.shape != force_N.shape:
        raise Error("force_N: found %d values, expected one for each of %d samples" % (len(force_N), len(contact)))
    folds = np.asarray(find_folds(depths_m) if folds is None else folds)
    if folds.shape != force_N.shape or folds.dtype.kind not in "iu":
        raise Error("folds: found dtype %s and shape %s, expected whole numbers and %s"
                    % (folds.dtype, folds.shape, force_N.shape))
    predicted_N = np.zeros(len(force_N))
    for fold in np.unique(folds):
        left_out = folds == fold
        if isinstance(estimator, Estimator):
            predicted_N[left_out] = estimator.fit_predict(recordings, ~left_out)[left_out]
            continue
        train, test = contact & ~left_out, contact & left_out
        if test.any():
            estimator.fit(features[train], force_N[train])
            predicted_N[test] = estimator.predict(features[test])
    error_N = (predicted_N - force_N)[contact]
    return CrossValidation(predicted_N, folds, within_jnd(predicted_N, force_N, contact),
                           float(np.sqrt(np.mean(error_N ** 2))))
